#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "connection/primary_link.hpp"
#include "connection/rtde_interfaces.hpp"
#include "motion/motion_tracker.hpp"
#include "program/control_scripts.hpp"
#include "ur_ros_rtde_robot/program/extension_options.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Runs the extensions of the control program, one at a time: sets the trigger, follows the acknowledgement
/// (float registers 18, see script_extension.hpp), and takes the trigger back, which ends what still runs.
class ExtensionRunner {
 public:
  ExtensionRunner(const RobotOptions & options, const StateReceiver & state, const MotionTracker & tracker,
                  RtdeInterfaces & interfaces, const ControlScripts & scripts);

  /// Returns when it is done, or has been ended: by the options, by an error in it, by a stop of the robot.
  Status run(const std::string & name, const ExtensionOptions & options);
  /// General purpose input registers, by their numbers without the offset of the upper range: 19 to 22.
  Status set_input(int index, std::int32_t value);
  Status set_input(int index, double value);

 private:
  struct Run;

  Status set_trigger(int id);
  Status check_input(int index) const;
  /// Done, or why not; nothing while it is under way.
  std::optional<Status> look(Run & run, const ExtensionOptions & options);
  Status failed(Run & run) const;
  bool wait_for_acknowledgement(double value, std::chrono::milliseconds limit) const;
  void end_early(Error & why);

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  RtdeInterfaces & interfaces_;
  const ControlScripts & scripts_;
  std::mutex running_;
};

}  // namespace ur_ros_rtde
