#include "ur_ros_rtde/dashboard_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "ur_ros_rtde/dashboard_command.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"

namespace ur_ros_rtde {
namespace {
using Seconds = std::chrono::duration<double>;

/// The answer of every version of the dashboard server to an unknown line.
constexpr std::string_view not_understood = "could not understand";

/// The dashboard server does not report changes, so the state is polled.
constexpr std::chrono::milliseconds polling_interval{50};
constexpr std::chrono::milliseconds answer_timeout{5000};
constexpr std::chrono::milliseconds confirmed_state_timeout{1000};
/// Of a goal that has to end, together shorter than the wait of a stop (startup_request_timeout in
/// plugin_host.cpp): for the answer, for the begin of the program, and for the end of the program.
constexpr std::chrono::milliseconds late_answer_timeout{1500};
constexpr std::chrono::milliseconds begin_of_program_timeout{1000};
constexpr std::chrono::milliseconds end_of_program_timeout{500};
constexpr std::chrono::hours longest_wait{24 * 365};

/// `timeout` in s.
std::chrono::milliseconds to_duration(double timeout)
{
  if (!(timeout > 0.0)) {  // also NaN
    return {};
  }
  return std::chrono::ceil<std::chrono::milliseconds>(std::min(Seconds(timeout), Seconds(longest_wait)));
}

bool begins_with(std::string_view text, std::string_view beginning)
{
  return text.substr(0, beginning.size()) == beginning;
}

std::string availability(const char * series, const MinVersion & minimum)
{
  return minimum.major == never.major
             ? fmt::format("{} does not have it", series)
             : fmt::format("{} has it from PolyScope {}.{} on", series, minimum.major, minimum.minor);
}

/// "RUNNING" of "Robotmode: RUNNING".
std::string without_label(const std::string & answer)
{
  const auto colon = answer.find(": ");
  return colon == std::string::npos ? answer : answer.substr(colon + 2);
}

bool is_one_of(const std::string & state, const std::vector<std::string> & states)
{
  return std::any_of(states.begin(), states.end(),
                     [&](const std::string & s) { return begins_with(state, s); });
}
}  // namespace

void check_text(const std::string & text, const std::vector<std::string> & texts, Check & check)
{
  check.that(texts.empty() || std::find(texts.begin(), texts.end(), text) != texts.end(),
             fmt::format("text is \"{}\", it may be {}", text, fmt::join(texts, ", ")));
}

Status supported(const std::string & action, const DashboardLimits & limits,
                 const DashboardConnection & connection)
{
  const auto version = connection.version();
  if (!version) {
    return {};
  }
  const MinVersion & minimum = version->cb3() ? limits.cb3 : limits.e_series;
  if (std::pair(version->major, version->minor) >= std::pair(minimum.major, minimum.minor)) {
    return {};
  }
  return failure(ErrorCode::not_supported,
                 fmt::format("{}: the controller has PolyScope {}; {}, {}", action, to_string(*version),
                             availability("an e-Series controller", limits.e_series),
                             availability("a CB3", limits.cb3)));
}

Error stopped_through_dashboard(const std::string & goal)
{
  return {ErrorCode::program_stopped, fmt::format("the script was stopped by {}", goal)};
}

Status dashboard_ready(const std::string & action, const DashboardLimits & limits, DashboardHost & host)
{
  if (Status has = host.has_dashboard_server(); !has) {
    return has;
  }
  const LinkStatus status = host.connection().link();
  if (status.connected) {
    return supported(action, limits, host.connection());
  }
  return failure(ErrorCode::link_lost, status.error.message.empty()
                                           ? std::string("not yet connected to the dashboard server")
                                           : status.error.message);
}

DashboardRun::DashboardRun(DashboardConnection & connection, std::shared_ptr<const StopRequest> stop_request,
                           BeginStart begin_start)
    : connection_(connection), stop_request_(std::move(stop_request)), begin_start_(std::move(begin_start))
{
}

std::string DashboardRun::send(const std::string & line)
{
  auto answer = connection_.request(line, answer_timeout, stop_request_->token());
  if (!answer) {
    throw RobotError(answer.error());
  }
  return *std::move(answer);
}

std::string DashboardRun::query_value(const std::string & question)
{
  return without_label(send(question));
}

Outcome DashboardRun::query(const std::string & question)
{
  answer_ = query_value(question);
  return begins_with(answer_, not_understood) ? rejection(question) : Outcome::success(answer_);
}

Outcome DashboardRun::raw(const std::string & line, double timeout)
{
  return take_answer(line, connection_.request(line, to_duration(timeout), stop_request_->token()));
}

Outcome DashboardRun::take_answer(const std::string & line, const Expected<std::string> & answer)
{
  if (!answer) {
    if (auto why = stop_reason()) {
      return *why;
    }
    return Outcome::failure(answer.error().code, fmt::format("\"{}\": {}", line, answer.error().message));
  }
  answer_ = *answer;
  return Outcome::success(answer_);
}

Outcome DashboardRun::command(const std::string & line, const std::string & reply,
                              const ExpectedState & expected, double timeout)
{
  const auto deadline = Clock::now() + to_duration(timeout);
  if (Outcome answered = raw(line, timeout); !answered) {
    return answered;
  }
  if (!begins_with(answer_, reply)) {
    return rejection(line);
  }
  return expected.query.empty() ? Outcome::success(answer_) : until(expected, deadline, timeout);
}

Outcome DashboardRun::start(const DashboardRequest & request, double timeout)
{
  const auto deadline = Clock::now() + to_duration(timeout);
  DashboardSession session(connection_.address());
  if (const Status connected = session.connect(to_duration(timeout), stop_request_->token()); !connected) {
    return take_answer(request.line, tl::unexpected(connected.error()));
  }
  auto under_way = begin_start();  // not before: a stop does not wait for the connection
  if (!under_way) {
    return under_way.error();
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  const auto answer = session.request_once(request.line, left, stop_request_->token(), late_answer_timeout);
  Outcome outcome = take_answer(request.line, answer);
  if (outcome && !begins_with(answer_, request.reply)) {
    under_way->reset();
    return rejection(request.line);
  }
  if (auto why = overtaken()) {
    outcome = *std::move(why);
  }
  const bool may_play = request.starts == Starts::program;
  if (!may_play) {
    under_way->reset();
  }
  if (outcome && !request.expected.query.empty()) {
    outcome = until(request.expected, deadline, timeout, may_play);
  }
  return may_play && !outcome ? end_program(outcome.error()) : outcome;
}

Expected<std::shared_ptr<void>> DashboardRun::begin_start()
{
  return begin_start_ ? begin_start_() : nullptr;
}

std::optional<Error> DashboardRun::overtaken()
{
  if (auto why = stop_reason()) {
    return why;
  }
  const auto start = begin_start();
  return start ? std::nullopt : std::make_optional(start.error());
}

Outcome DashboardRun::end_program(Error why)
{
  DashboardSession session(connection_.address());
  const auto deadline = Clock::now() + begin_of_program_timeout;
  bool has_begun = false;  // it could not be stopped before
  for (auto now = Clock::now(); now < deadline && !has_begun; now = Clock::now()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - now);
    const auto state = session.request("programState", left);
    has_begun = state && begins_with(*state, "PLAYING");
    if (!has_begun) {
      std::this_thread::sleep_for(polling_interval);
    }
  }
  const auto answer = session.request("stop", end_of_program_timeout);
  if (!has_begun || !answer || !begins_with(*answer, "Stopped")) {
    why.message += fmt::format("; its program {}: look at the pendant",
                               has_begun ? "was not stopped by this goal" : "may still begin");
  }
  return why;
}

Outcome DashboardRun::execute(const DashboardRequest & request, double timeout)
{
  if (request.starts != Starts::nothing) {
    return start(request, timeout);
  }
  return request.reply.empty() ? query(request.line)
                               : command(request.line, request.reply, request.expected, timeout);
}

Outcome DashboardRun::rejection(const std::string & line)
{
  std::string answer = fmt::format("the dashboard server answered \"{}\" to \"{}\"", answer_, line);
  if (begins_with(answer_, not_understood)) {
    return Outcome::failure(ErrorCode::not_supported,
                            answer + ": this version of PolyScope does not have it");
  }
  if (connection_.in_remote_control()) {
    // Queried again: the value known from the heartbeat may be older than the command.
    const auto remote = connection_.request("is in remote control", answer_timeout, stop_request_->token());
    if (remote && *remote == "false") {
      answer += ": the robot is in local control, switch it to remote on the teach pendant";
    }
  }
  return Outcome::failure(ErrorCode::rejected_by_robot, answer);
}

Outcome DashboardRun::until(const ExpectedState & expected, Clock::time_point deadline, double timeout,
                            bool starts_program)
{
  std::string shown;
  if (expected.is_confirmed_by_answer) {
    deadline = std::min(deadline, Clock::now() + confirmed_state_timeout);
  }
  DashboardSession session(connection_.address());
  const auto query_timeout = starts_program ? late_answer_timeout : answer_timeout;
  while (true) {
    const auto answer = session.request(expected.query, query_timeout, stop_request_->token());
    if (!answer) {
      return stop_reason().value_or(answer.error());
    }
    if (auto why = starts_program ? overtaken() : std::nullopt) {
      return *why;
    }
    const std::string state = without_label(*answer);
    if (state != shown) {
      shown = state;
      publish_state(state);
    }
    if (is_one_of(state, expected.states)) {
      return Outcome::success(fmt::format("{} is {}", expected.query, state));
    }
    if (Clock::now() >= deadline) {
      if (expected.is_confirmed_by_answer) {
        return Outcome::success(fmt::format("{}; {} is {} now", answer_, expected.query, state));
      }
      return Outcome::failure(
          ErrorCode::timeout,
          fmt::format("{} is still {} after {:.1f} s, not {} (the command was answered \"{}\")",
                      expected.query, state, timeout, fmt::join(expected.states, " or "), answer_));
    }
    if (auto why = sleep_for(polling_interval)) {
      return *why;
    }
  }
}

std::optional<StopReason> DashboardRun::sleep_for(std::chrono::nanoseconds duration)
{
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop_request_->token(), std::min<std::chrono::nanoseconds>(duration, longest_wait),
                [] { return false; });
  return stop_reason();
}

}  // namespace ur_ros_rtde
