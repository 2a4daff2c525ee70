#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "connection/primary_connection.hpp"
#include "connection/rtde/control_scripts.hpp"
#include "connection/rtde/rtde_interfaces.hpp"
#include "motion/motion_tracker.hpp"
#include "ur_ros_rtde_robot/program/extension_options.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Runs the extensions of the control program, one at a time: sets the trigger, waits for the acknowledgement
/// (float registers 18, see script_extension.hpp) and clears the trigger, which ends an extension that still
/// runs.
class ExtensionRunner {
 public:
  ExtensionRunner(const RobotOptions & options, const StateReceiver & state, const MotionTracker & tracker,
                  RtdeInterfaces & interfaces, const ControlScripts & scripts);

  /// Returns when the extension has finished, or was ended by the options, an error or a stop of the robot.
  Status run(const std::string & name, const ExtensionOptions & options);
  /// Writes general purpose input register 19 to 22, without the offset of the upper range.
  Status set_input(int index, std::int32_t value);
  Status set_input(int index, double value);

 private:
  struct Run;

  Status check_input(int index) const;
  template <class Write>
  Status write_register(const std::string & what, Write write);
  Status set_trigger(int id);
  bool wait_for_acknowledgement(double value) const;
  Status wait_for_result(Run & run, const ExtensionOptions & options);
  /// None while the extension is running.
  std::optional<Status> result(Run & run, const ExtensionOptions & options) const;
  Status failure_of(Run & run) const;
  bool stop_extension();

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  RtdeInterfaces & interfaces_;
  const ControlScripts & scripts_;
  std::mutex running_;
};

}  // namespace ur_ros_rtde
