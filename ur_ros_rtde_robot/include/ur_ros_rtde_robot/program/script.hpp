#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// How the controller runs a script.
enum class ScriptKind {
  /// `def name(): … end`. Replaces the control program while it runs; may move the arm.
  program,
  /// `sec name(): … end`. Runs beside the control program without disturbing it; must not take physical time.
  secondary,
};

/// How a script ended.
enum class ScriptEnd {
  finished,       ///< reached its end, or a `return` or `halt` of its own
  rejected,       ///< not sent; see the error
  compile_error,  ///< rejected by the controller's compiler; no part of it ran
  runtime_error,  ///< aborted by the controller because of an error in the script
  stopped,        ///< stopped on the pendant, by a dashboard command or by another program
  robot_stopped,  ///< protective, safeguard or emergency stop, or the arm was powered off
  interrupted,    ///< ScriptOptions::stop_reason returned a reason
  timeout,        ///< ScriptOptions::timeout was exceeded
  link_lost,      ///< the connection was lost; the outcome is unknown
};

const char * to_string(ScriptEnd end);

/// How a script is run, and for how long.
struct ScriptOptions {
  ScriptKind kind = ScriptKind::program;
  /// Time from sending the script to its end: at least 1 ms; at most 10 s for a secondary program.
  std::chrono::milliseconds timeout = std::chrono::minutes(10);
  /// A program that is paused, on the pendant, by the dashboard or by a blocking `popup`, is waited for, and
  /// may go on. Otherwise it is ended. After a safety stop, it always is.
  bool may_be_paused = false;
  /// Called every few milliseconds in the calling thread: the reason to stop the script early, if there is
  /// one. In a command: `[&run] { return run.stop_reason(); }`.
  std::function<std::optional<Error>()> stop_reason;
  /// For a secondary program: nothing is sent after this was requested, however late the calling thread is.
  /// stop_reason then names why.
  std::stop_token stop;
  /// Called in the calling thread with each line of `textmsg` as it arrives.
  std::function<void(const std::string & text)> on_text;
};

/// What a script has written, and how it ended.
struct ScriptReport {
  ScriptEnd end = ScriptEnd::rejected;
  /// ErrorCode::none if the script finished. A compile or run-time error is rejected_by_robot, with line and
  /// text in the message.
  Error error;
  /// Line of the compile or run-time error in the script as passed to run_script(), from 1; 0: unknown.
  int line = 0;
  /// The first 1,000 lines that the script wrote with `textmsg`, in order.
  std::vector<std::string> text;
  /// s, from sending the script to its end, in this host's time.
  double duration = 0.0;

  explicit operator bool() const { return end == ScriptEnd::finished; }
};

}  // namespace ur_ros_rtde
