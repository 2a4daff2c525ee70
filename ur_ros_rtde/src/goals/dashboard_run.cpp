#include "ur_ros_rtde/dashboard_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ur_rtde/dashboard_client.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;

/// The dashboard server tells nothing unasked, so states are asked for.
constexpr std::chrono::milliseconds question_interval{50};

bool begins_with(std::string_view text, std::string_view beginning)
{
  return text.substr(0, beginning.size()) == beginning;
}

bool is_one_of(const std::string & state, const std::vector<std::string> & states)
{
  return std::any_of(states.begin(), states.end(),
                     [&](const std::string & s) { return begins_with(state, s); });
}
}  // namespace

Status dashboard_ready(const DashboardLink & link)
{
  const LinkStatus status = link.link();
  if (status.connected) {
    return {};
  }
  return failure(ErrorCode::link_lost, status.error.message.empty()
                                           ? std::string("not yet connected to the dashboard server")
                                           : status.error.message);
}

DashboardRun::DashboardRun(DashboardLink & link, std::shared_ptr<Interrupt> interrupt, PublishState publish)
    : link_(link), interrupt_(std::move(interrupt)), publish_(std::move(publish))
{
}

std::string DashboardRun::ask(const std::string & line)
{
  std::string answer;
  const Status asked = link_.call([&](ur_rtde::DashboardClient & client) {
    client.send(line + "\n");
    answer = client.receive();
  });
  if (!asked) {
    throw RobotError(asked.error());
  }
  while (!answer.empty() && (answer.back() == '\n' || answer.back() == '\r')) {
    answer.pop_back();
  }
  return answer;
}

std::string DashboardRun::ask_value(const std::string & question)
{
  const std::string answer = ask(question);
  const auto colon = answer.find(": ");
  return colon == std::string::npos ? answer : answer.substr(colon + 2);
}

Outcome DashboardRun::query(const std::string & question)
{
  answer_ = ask_value(question);
  return Outcome::success(answer_);
}

Outcome DashboardRun::command(const std::string & line, const std::string & reply,
                              const std::optional<Effect> & effect, double timeout)
{
  answer_ = ask(line);
  if (!begins_with(answer_, reply)) {
    const auto remote = link_.in_remote_control();
    return Outcome::failure(
        ErrorCode::rejected_by_robot,
        fmt::format("the dashboard server answered \"{}\" to \"{}\"{}", answer_, line,
                    remote == false
                        ? ": the robot is in local control, switch it to remote on the teach pendant"
                        : ""));
  }
  return effect ? until(*effect, timeout) : Outcome::success(answer_);
}

Outcome DashboardRun::until(const Effect & effect, double timeout)
{
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
  std::string shown;
  while (true) {
    const std::string state = ask_value(effect.question);
    if (state != shown) {
      shown = state;
      publish_(state);
    }
    if (is_one_of(state, effect.states)) {
      return Outcome::success(fmt::format("{} is {}", effect.question, state));
    }
    if (Clock::now() >= deadline) {
      return Outcome::failure(
          ErrorCode::timeout,
          fmt::format("{} is still {} after {:.1f} s, not {} (the command was answered \"{}\")",
                      effect.question, state, timeout, fmt::join(effect.states, " or "), answer_));
    }
    if (auto why = sleep_for(question_interval)) {
      return *why;
    }
  }
}

std::optional<Interruption> DashboardRun::sleep_for(std::chrono::nanoseconds duration)
{
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, interrupt_->token(), duration, [] { return false; });
  return interruption();
}

}  // namespace ur_ros_rtde
