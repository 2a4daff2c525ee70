#include "program/script_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "program/motion_blocker.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t most_lines = 1000;
constexpr milliseconds send_limit(1000);
constexpr milliseconds begin_limit(3000);
/// Primary interface and RTDE are two connections: what happened in one cycle may come this much apart.
constexpr milliseconds apart(100);
constexpr milliseconds nap(4);

double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

/// `text` with the line it names replaced: the controller counts lines that were added.
std::string with_line(std::string text, int sent_line, int line)
{
  const std::string sent = std::to_string(sent_line);
  const auto found = text.find(sent, std::min(text.find("line"), text.size()));
  if (line > 0 && found != std::string::npos) {
    text.replace(found, sent.size(), std::to_string(line));
  }
  return text;
}

/// Errors of secondary programs say so; another one may run beside the program.
bool is_of_a_secondary(const std::string & text)
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
    case ScriptEnd::refused:
      return "refused";
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

ScriptWatch::ScriptWatch(PrimaryLink primary, const StateReceiver & state, Marks marks,
                         const ScriptOptions & options)
    : primary_(std::move(primary)), state_(state), marks_(std::move(marks)), options_(options)
{
}

ScriptReport ScriptWatch::report() const
{
  return report_;
}

void ScriptWatch::end(ScriptEnd how, ErrorCode code, std::string message)
{
  ended_ = true;
  running_ = how == ScriptEnd::robot_stopped || how == ScriptEnd::interrupted || how == ScriptEnd::timeout ||
             how == ScriptEnd::link_lost;
  report_.end = how;
  report_.error = {code, std::move(message)};
  report_.duration = seconds(Clock::now() - sent_);
}

void ScriptWatch::follow(const script::Program & program)
{
  program_ = &program;
  sent_ = Clock::now();
  if (const auto sent = primary_.send(program.text.text(), send_limit); !sent) {
    end(ScriptEnd::link_lost, sent.error().code, "the script could not be sent: " + sent.error().message);
    return;
  }
  while (!look()) {
  }
}

bool ScriptWatch::look()
{
  return !listen() || has_failed() || has_ended() || has_to_end();
}

bool ScriptWatch::listen()
{
  auto wait = nap;
  for (auto message = primary_.next(wait); true; message = primary_.next(wait)) {
    if (!message) {
      end(ScriptEnd::link_lost, message.error().code,
          "what becomes of the script is not known any more: " + message.error().message);
      return false;
    }
    if (!*message) {
      return true;
    }
    hear(**message);
    wait = milliseconds(0);
  }
}

void ScriptWatch::hear(const PrimaryMessage & message)
{
  switch (message.kind) {
    case PrimaryMessage::Kind::text:
      if (message.text == marks_.begin) {
        began_ = Clock::now();
      } else if (message.text == marks_.end) {
        said_end_ = Clock::now();
      } else if (began_ && !said_end_) {
        if (report_.text.size() < most_lines) {
          report_.text.push_back(message.text);
        }
        if (options_.on_text) {
          options_.on_text(message.text);
        }
      }
      break;
    case PrimaryMessage::Kind::error:
      if (!failed_ && (options_.kind == ScriptKind::secondary || !is_of_a_secondary(message.text))) {
        failed_ = Clock::now();
        failure_ = message;
      }
      break;
    case PrimaryMessage::Kind::program_started:
      if (began_ && message.text != program_->name) {
        replaced_by_ = message.text;
      }
      break;
    case PrimaryMessage::Kind::program_stopped:
      break;
  }
}

/// The controller's refusal comes before the program's beginning, if there is one; errors of other programs
/// come at any time.
bool ScriptWatch::has_failed()
{
  const bool refused = failed_ && !began_ && Clock::now() - *failed_ > apart;
  const bool failed_beside = options_.kind == ScriptKind::secondary && failed_ && began_ && !said_end_ &&
                             Clock::now() - *failed_ > apart;
  if (refused || failed_beside) {
    end_by_error();
  }
  return ended_;
}

void ScriptWatch::end_by_error()
{
  report_.line = failure_.line > 0 ? program_->text.origin(failure_.line).line : 0;
  const std::string text = with_line(failure_.text, failure_.line, report_.line);
  if (began_) {
    end(ScriptEnd::runtime_error, ErrorCode::rejected_by_robot,
        fmt::format("the controller ended the script: {}", text));
  } else {
    end(ScriptEnd::compile_error, ErrorCode::rejected_by_robot,
        fmt::format("the controller does not take the script: {}", text));
  }
}

bool ScriptWatch::has_ended()
{
  const auto now = Clock::now();
  if (options_.kind == ScriptKind::secondary) {
    if (said_end_) {
      end(ScriptEnd::finished, ErrorCode::none, {});
    }
    return ended_;
  }
  const auto sample = state_.latest();
  played_ = played_ || (began_ && sample && sample->received > *began_ && sample->program_running());
  const bool stopped = began_ && sample && sample->received > *began_ &&
                       sample->runtime_state == RuntimeState::stopped &&
                       (played_ || now - *began_ > (said_end_ ? apart / 5 : apart));
  if (!stopped) {
    return false;
  }
  seen_stopped_ = seen_stopped_.value_or(now);
  if (said_end_ && !(failed_ && *failed_ >= *said_end_)) {
    end(ScriptEnd::finished, ErrorCode::none, {});
  } else if (failed_) {
    end_by_error();
  } else if (now - *seen_stopped_ > apart) {
    end(ScriptEnd::stopped, ErrorCode::program_stopped,
        "the script was stopped: on the pendant, by the dashboard, or by another program");
  }
  return ended_;
}

bool ScriptWatch::has_to_end()
{
  const auto link = state_.link();
  const auto sample = state_.latest();
  if (!link.connected || !sample) {
    end(ScriptEnd::link_lost, ErrorCode::link_lost, link.error.message);
    return true;
  }
  if (!replaced_by_.empty()) {
    end(ScriptEnd::stopped, ErrorCode::program_stopped,
        fmt::format("another program, `{}`, took the script's place", replaced_by_));
    return true;
  }
  const auto condition = options_.kind == ScriptKind::program ? motion_blocker(*sample) : std::nullopt;
  if (condition) {
    end(ScriptEnd::robot_stopped, condition->code, condition->message);
    return true;
  }
  if (options_.stop_reason) {
    if (const auto why = options_.stop_reason()) {
      end(ScriptEnd::interrupted, why->code, why->message);
      return true;
    }
  }
  const auto elapsed = Clock::now() - sent_;
  if (elapsed > options_.limit) {
    end(ScriptEnd::timeout, ErrorCode::timeout,
        fmt::format("the script had not ended after {:.1f} s", seconds(elapsed)));
  } else if (!began_ && elapsed > begin_limit) {
    end(ScriptEnd::timeout, ErrorCode::timeout,
        fmt::format("the controller has not begun the script after {:.1f} s: is the robot in remote control?",
                    seconds(elapsed)));
  }
  return ended_;
}

}  // namespace ur_ros_rtde
