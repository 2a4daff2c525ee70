#pragma once

#include <functional>
#include <optional>
#include <thread>

#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Watches the robot from a thread of its own, during goals of all commands and between them, as long as it
/// exists: a part that is lost at the gripper, a door, a sensor. As soon as there is a reason, the arm is
/// stopped, and the goal that moves it ends with that reason. The next goal may move the arm even if the
/// reason persists; it stops the arm again once it has been gone. The thread runs with each package: create
/// the object when there is something to watch.
///
///     void on_load(CommandHost & host) override
///     {
///       supervision_.emplace(host, StopOptions{}, [this](const Sample & sample) { return lost(sample); });
///     }
///     void on_unload() override { supervision_.reset(); }
class Supervision {
 public:
  /// Why the arm has to be stopped; empty: it may move. Called with each new sample (it skips some on a late
  /// host), on the thread of the supervision. An exception is a reason.
  using Condition = std::function<std::optional<Error>(const Sample &)>;

  /// `host` outlives this object. `options`: how the arm is stopped.
  Supervision(CommandHost & host, const StopOptions & options, Condition condition);

 private:
  void watch(const std::stop_token & stop);
  std::optional<Error> evaluate(const Sample & sample) const;

  CommandHost & host_;
  const StopOptions options_;
  const Condition condition_;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
