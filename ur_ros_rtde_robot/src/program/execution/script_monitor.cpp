#include "program/execution/script_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "connection/skew.hpp"
#include "motion/motion_blocker.hpp"
#include "motion/started_activities.hpp"
#include "program/program_state_machine.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t max_lines = 1000;
constexpr milliseconds send_timeout(1000);
constexpr milliseconds message_wait(4);
constexpr std::string_view control_program = "rtde_control";  ///< its name, given by ur_rtde

double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

/// Replaces the line number in the controller's error text, which counts the added lines, by that of the
/// original script. Adds it if the text has none.
std::string with_original_line(std::string text, int sent_line, int original_line)
{
  const std::string syntax_error = fmt::format("syntax_error_on_line:{}:", sent_line);
  if (original_line > 0 && text.starts_with(syntax_error)) {
    return fmt::format("syntax error in line {}: {}", original_line, text.substr(syntax_error.size()));
  }
  if (original_line > 0 && text.find("line") == std::string::npos) {
    return fmt::format("{} (line {})", text, original_line);
  }
  const std::string sent = std::to_string(sent_line);
  const auto found = text.find(sent, std::min(text.find("line"), text.size()));
  if (original_line > 0 && found != std::string::npos) {
    text.replace(found, sent.size(), std::to_string(original_line));
  }
  return text;
}

/// Whether the controller means the program of this name: it may report the first characters only (UR's
/// client library keeps its names to 31 for that reason).
bool is_program(std::string_view reported, std::string_view name)
{
  constexpr std::size_t reported_characters = 31;
  return reported == name || (reported.size() >= reported_characters && name.starts_with(reported));
}

/// The controller labels errors of secondary programs, which may run beside the monitored program.
bool is_from_secondary_program(const std::string & text)
{
  constexpr std::string_view word = "secondary";
  return text.size() >= word.size() && std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

}  // namespace

const char * to_string(ScriptEnd end)
{
  switch (end) {
    case ScriptEnd::finished:
      return "finished";
    case ScriptEnd::rejected:
      return "rejected";
    case ScriptEnd::compile_error:
      return "compile error";
    case ScriptEnd::runtime_error:
      return "run-time error";
    case ScriptEnd::stopped:
      return "stopped";
    case ScriptEnd::robot_stopped:
      return "robot stopped";
    case ScriptEnd::interrupted:
      return "interrupted";
    case ScriptEnd::timeout:
      return "timeout";
    case ScriptEnd::link_lost:
      return "link lost";
  }
  return "unknown";
}

ScriptMonitor::ScriptMonitor(PrimaryConnection primary, const StateReceiver & state, Markers markers,
                             const ScriptOptions & options)
    : primary_(std::move(primary)), state_(state), markers_(std::move(markers)), options_(options)
{
}

void ScriptMonitor::fence() const
{
  if (!is_sent_) {
    primary_.shut_down_sending();
  }
}

ScriptReport ScriptMonitor::report() const
{
  return report_;
}

bool ScriptMonitor::complete(ScriptEnd end, ErrorCode code, std::string message)
{
  may_be_running_ = end == ScriptEnd::robot_stopped || end == ScriptEnd::interrupted ||
                    end == ScriptEnd::timeout || end == ScriptEnd::link_lost;
  report_.end = end;
  report_.error = {code, std::move(message)};
  report_.duration = seconds(Clock::now() - sent_);
  return true;
}

void ScriptMonitor::run(const script::Program & program)
{
  program_ = &program;
  link_ = state_.latest().value_or(Sample{}).link;
  sent_ = Clock::now();
  if (complete_if_told(ScriptEnd::rejected) ||
      (options_.kind == ScriptKind::program && replaced_before_begin())) {
    return;
  }
  error_seen_.reset();  // of another program
  if (const auto sent = primary_.send(program.text.text(), send_timeout); !sent) {
    if (!complete_if_told(ScriptEnd::rejected)) {
      complete(ScriptEnd::link_lost, sent.error().code,
               "the script could not be sent: " + sent.error().message);
    }
    return;
  }
  is_sent_ = true;
  while (!update()) {
  }
}

/// The connection is older than the end of the control program: it has told of a program that began in
/// between.
bool ScriptMonitor::replaced_before_begin()
{
  do {
    if (read_messages(milliseconds(0))) {
      return true;
    }
  } while (messages_left_ && !replaced() && Clock::now() - sent_ < send_timeout);
  return replaced() &&
         complete(ScriptEnd::rejected, ErrorCode::program_stopped,
                  fmt::format("another program, `{}`, began before the script was sent", replaced_by_));
}

bool ScriptMonitor::update()
{
  return read_messages(message_wait) || (!messages_left_ && (complete_if_failed() || complete_if_ended())) ||
         complete_if_it_must_stop();
}

/// Bounded in time, so that a script that writes faster than ScriptOptions::on_text returns can be stopped.
bool ScriptMonitor::read_messages(milliseconds wait)
{
  const auto deadline = Clock::now() + message_wait;
  do {
    const auto message = primary_.next(wait);
    if (!message && complete_if_told(ScriptEnd::interrupted)) {
      return true;  // the controller may close a connection that was fenced
    }
    if (!message) {
      return complete(ScriptEnd::link_lost, message.error().code,
                      "the outcome of the script is unknown: " + message.error().message);
    }
    messages_left_ = message->has_value();
    if (messages_left_) {
      on_message(**message);
    }
    wait = milliseconds(0);
  } while (messages_left_ && Clock::now() < deadline);
  return false;
}

void ScriptMonitor::on_text(const std::string & text)
{
  if (text == markers_.begin) {
    begin_seen_ = Clock::now();
    on_compiled();
  } else if (text == markers_.end) {
    end_seen_ = Clock::now();
  } else if (begin_seen_ && !end_seen_) {
    if (report_.text.size() < max_lines) {
      report_.text.push_back(text);
    }
    if (options_.on_text) {
      options_.on_text(text);
    }
  }
}

void ScriptMonitor::on_message(const PrimaryMessage & message)
{
  switch (message.kind) {
    case PrimaryMessage::Kind::text:
      on_text(message.text);
      break;
    case PrimaryMessage::Kind::error:
      if (!error_seen_ &&
          (options_.kind == ScriptKind::secondary || !is_from_secondary_program(message.text))) {
        error_seen_ = Clock::now();
        error_ = message;
      }
      break;
    case PrimaryMessage::Kind::error_code:
      if (begin_seen_) {
        error_code_ = message.text;
      }
      break;
    case PrimaryMessage::Kind::program_started:
      if (!started_ && is_program(message.text, program_->name)) {
        started_ = Clock::now();
      }
      // The begin of the control program may be told late.
      if (options_.kind == ScriptKind::program && !is_program(message.text, program_->name) &&
          message.text != control_program) {
        replaced_by_ = message.text;
      }
      break;
    case PrimaryMessage::Kind::program_stopped:
      if (started_ && !begin_seen_ && is_program(message.text, program_->name)) {
        ended_before_begin_ = true;
        on_compiled();
      }
      break;
  }
}

/// A compile error arrives without a begin marker. Errors of other programs can arrive at any time.
bool ScriptMonitor::complete_if_failed()
{
  if (!error_seen_ || Clock::now() - *error_seen_ <= max_skew) {
    return false;
  }
  const bool compile_error = !begin_seen_;
  const bool secondary_failed = options_.kind == ScriptKind::secondary && begin_seen_ && !end_seen_;
  return (compile_error || secondary_failed) && complete_with_error();
}

bool ScriptMonitor::complete_with_error()
{
  report_.line = error_.line > 0 ? program_->text.origin(error_.line).line : 0;
  const std::string text = with_original_line(error_.text, error_.line, report_.line);
  if (begin_seen_) {
    return complete(ScriptEnd::runtime_error, ErrorCode::rejected_by_robot,
                    fmt::format("the controller ended the script: {}", text));
  }
  return complete(ScriptEnd::compile_error, ErrorCode::rejected_by_robot,
                  fmt::format("the controller does not take the script: {}", text));
}

bool ScriptMonitor::complete_if_ended()
{
  if (ended_before_begin_) {
    return complete_as_stopped();
  }
  const auto now = Clock::now();
  if (options_.kind == ScriptKind::secondary) {
    return end_seen_ && complete(ScriptEnd::finished, ErrorCode::none, {});
  }
  const auto sample = state_.latest();
  if (!begin_seen_ || !sample || sample->received <= *begin_seen_) {
    return false;
  }
  has_played_ = has_played_ || sample->is_program_running();
  const bool stopped = sample->runtime_state == RuntimeState::stopped &&
                       (has_played_ || now - *begin_seen_ > (end_seen_ ? max_skew / 5 : max_skew));
  if (!stopped) {
    stop_seen_.reset();  // what had been seen was older than the script
    return false;
  }
  stop_seen_ = stop_seen_.value_or(now);
  if (end_seen_ && !(error_seen_ && *error_seen_ >= *end_seen_)) {
    return complete(ScriptEnd::finished, ErrorCode::none, {});
  }
  if (error_seen_) {
    return complete_with_error();
  }
  if (now - *stop_seen_ <= max_skew) {
    return false;
  }
  if (!error_code_.empty()) {
    return complete(ScriptEnd::runtime_error, ErrorCode::rejected_by_robot,
                    fmt::format("the controller ended the script: {}", error_code_));
  }
  return complete_as_stopped();
}

bool ScriptMonitor::complete_as_stopped()
{
  return complete(ScriptEnd::stopped, ErrorCode::program_stopped,
                  "the script was stopped: on the pendant, by the dashboard, or by another program");
}

bool ScriptMonitor::complete_if_it_must_stop()
{
  const auto link = state_.link();
  const auto sample = state_.latest();
  if (!link.connected || !sample) {
    return complete(ScriptEnd::link_lost, ErrorCode::link_lost, link.error.message);
  }
  if (sample->link != link_) {
    return complete(ScriptEnd::link_lost, ErrorCode::link_lost, connection_replaced);
  }
  if (replaced()) {
    // Before its begin, the script has been sent after that program, and replaces it.
    return complete(begin_seen_ ? ScriptEnd::stopped : ScriptEnd::interrupted, ErrorCode::program_stopped,
                    fmt::format("another program, `{}`, took the script's place", replaced_by_));
  }
  if (options_.kind == ScriptKind::program) {
    if (const auto blocker = motion_blocker(*sample)) {
      return complete(ScriptEnd::robot_stopped, blocker->code, blocker->message);
    }
    if (!options_.may_be_paused && is_paused(*sample)) {
      on_compiled();  // it may have been paused before its first line
      return complete(ScriptEnd::robot_stopped, ErrorCode::program_stopped,
                      "the program was paused on the pendant or by the dashboard, which ends it");
    }
  }
  return complete_if_told(ScriptEnd::interrupted) || complete_if_late();
}

void ScriptMonitor::read_until_compiled(const std::function<bool()> & ends)
{
  while (!begin_seen_ && !ended_before_begin_ && !ends()) {  // an error may be that of another program
    const auto message = primary_.next(message_wait);
    if (!message) {
      return;
    }
    if (*message) {
      on_message(**message);
    }
  }
}

/// A safety stop pauses the program, too, and is told by its own bits. The program may have been paused
/// before a sample has shown it running.
bool ScriptMonitor::is_paused(const Sample & sample)
{
  const auto begin = begin_seen_ ? begin_seen_ : started_;
  if (!begin || sample.received <= *begin || !is_pause(sample.runtime_state)) {
    pause_seen_.reset();
    return false;
  }
  const auto now = Clock::now();
  pause_seen_ = pause_seen_.value_or(now);
  return now - *pause_seen_ > max_skew;
}

bool ScriptMonitor::complete_if_told(ScriptEnd end)
{
  const auto reason = options_.stop_reason ? options_.stop_reason() : std::nullopt;
  return reason && complete(end, reason->code, reason->message);
}

bool ScriptMonitor::complete_if_late()
{
  const auto elapsed = Clock::now() - sent_;
  if (elapsed > options_.timeout) {
    return complete(ScriptEnd::timeout, ErrorCode::timeout,
                    fmt::format("the script had not ended after {:.1f} s", seconds(elapsed)));
  }
  if (!begin_seen_ && elapsed > StartedActivities::Script::begin_limit) {
    return complete(
        ScriptEnd::timeout, ErrorCode::timeout,
        fmt::format("the controller has not begun the script after {:.1f} s: is the robot in remote control?",
                    seconds(elapsed)));
  }
  return false;
}

}  // namespace ur_ros_rtde
