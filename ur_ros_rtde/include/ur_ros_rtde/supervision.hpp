#pragma once

#include <functional>
#include <optional>
#include <thread>

#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Of the goals that would move the arm while a Supervision has a reason to stop it.
enum class WhileReasonPersists {
  reject,  ///< they are rejected with the reason
  allow,   ///< they may move the arm: it is stopped again once the reason has been gone
};

/// Watches the robot from a thread of its own, during goals of all commands and between them, as long as it
/// exists: a part that is lost at the gripper, a door, a sensor. As soon as there is a reason, the arm is
/// stopped, and the goal that moves it ends with that reason. The thread runs with each package: create the
/// object when there is something to watch.
///
///     void on_load(CommandHost & host) override
///     {
///       supervision_.emplace(host, StopOptions{}, WhileReasonPersists::reject,
///                            [this](const Sample & sample) { return open_door(sample); });
///     }
///     void on_unload() override { supervision_.reset(); }
class Supervision {
 public:
  /// Why the arm has to be stopped; empty: it may move. Called with each new sample (it skips some on a late
  /// host), on the thread of the supervision. An exception is a reason, and goals are rejected while it
  /// persists.
  using Condition = std::function<std::optional<Error>(const Sample &)>;

  /// `host` outlives this object. `options`: how the arm is stopped.
  Supervision(CommandHost & host, const StopOptions & options, WhileReasonPersists next, Condition condition);
  /// Waits for the end of the condition: not from within it.
  ~Supervision();
  Supervision(const Supervision &) = delete;
  Supervision & operator=(const Supervision &) = delete;

  /// Ends the supervision, at the latest after the condition that is being evaluated; from any thread, also
  /// from within the condition.
  void end() { thread_.request_stop(); }

 private:
  void watch(const std::stop_token & stop);
  std::optional<Error> evaluate(const Sample & sample);

  CommandHost & host_;
  const StopOptions options_;
  const WhileReasonPersists next_;
  const Condition condition_;
  bool has_thrown_ = false;  ///< at the last evaluation
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
