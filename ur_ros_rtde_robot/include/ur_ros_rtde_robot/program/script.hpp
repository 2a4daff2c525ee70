#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

enum class ScriptKind {
  /// `def name(): … end`. Takes the place of the control program while it runs; may move the arm.
  program,
  /// `sec name(): … end`. Runs beside the control program and does not disturb it; must not take physical
  /// time.
  secondary,
};

/// How a script ended.
enum class ScriptEnd {
  finished,       ///< it ran to its end (or to a `return` or `halt` of its own)
  refused,        ///< nothing was sent: see the error
  compile_error,  ///< the controller did not take it: nothing of it ran
  runtime_error,  ///< the controller ended it for an error in it
  stopped,        ///< somebody stopped it: on the pendant, by the dashboard, by another program
  robot_stopped,  ///< a protective, safeguard or emergency stop, a powered off arm
  interrupted,    ///< ScriptOptions::interrupted said so
  timeout,        ///< the limit was over
  link_lost,      ///< what became of it is not known
};

const char * to_string(ScriptEnd end);

struct ScriptOptions {
  ScriptKind kind = ScriptKind::program;
  /// From the sending to the end; at least 1 ms. Longest for a secondary program: 10 s.
  std::chrono::milliseconds limit = std::chrono::minutes(10);
  /// Asked every few milliseconds: why the script has to end early, if it has to. For a command:
  /// `[&run] { return run.stop_reason(); }`.
  std::function<std::optional<Error>()> interrupted;
  /// Each line of `textmsg` when it comes, in the calling thread.
  std::function<void(const std::string & text)> on_text;
};

struct ScriptReport {
  ScriptEnd end = ScriptEnd::refused;
  /// ErrorCode::none when it finished. A compile or run-time error is rejected_by_robot, with line and text
  /// in the message.
  Error error;
  /// Of the compile or run-time error: line of the script as it was given, from 1; 0: not known.
  int line = 0;
  /// What the script wrote with `textmsg`, in order; of more than 1,000 lines the first 1,000.
  std::vector<std::string> text;
  /// s of this host's time, from the sending to the end.
  double duration = 0.0;

  explicit operator bool() const { return end == ScriptEnd::finished; }
};

}  // namespace ur_ros_rtde
