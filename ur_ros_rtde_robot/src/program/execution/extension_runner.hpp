#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "connection/primary_connection.hpp"
#include "connection/rtde/control_scripts.hpp"
#include "connection/rtde/input_registers.hpp"
#include "motion/motion_tracker.hpp"
#include "ur_ros_rtde_robot/program/extension_options.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Runs the extensions of the control program, one at a time: sets the trigger, waits for the acknowledgement
/// (float registers 18, see script_extension.hpp) and clears the trigger.
class ExtensionRunner {
 public:
  ExtensionRunner(const RobotOptions & options, const StateReceiver & state, const MotionTracker & tracker,
                  InputRegisters & registers, const ControlScripts & scripts)
      : options_(options), state_(state), tracker_(tracker), registers_(registers), scripts_(scripts)
  {
  }

  /// Starts the extension if `permission` succeeds when nothing can come in between anymore. Returns when it
  /// has finished, or was ended by the options, an error or a stop of the robot. If it fails, the caller
  /// stops the arm: the extension may still run.
  Status run(const std::string & name, const ExtensionOptions & options,
             const InputRegisters::Permission & permission);

 private:
  struct Run;

  bool wait_for_acknowledgement(double value) const;
  Status wait_for_result(Run & run, const ExtensionOptions & options) const;
  /// None while the extension is running.
  std::optional<Status> result(Run & run, const ExtensionOptions & options) const;
  Status failure_of(Run & run) const;
  Status trigger_lost(const Run & run) const;
  /// Takes the newest acknowledgement and the state of the IO connection.
  void update(Run & run, const Sample & sample) const;
  /// The IO connection stays closed, or was opened again before the extension began.
  bool has_lost_connection(const Run & run) const;
  /// The control program has not begun the extension in time.
  static bool is_ignored(const Run & run, const Sample & sample);

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  InputRegisters & registers_;
  const ControlScripts & scripts_;
  std::mutex running_;
};

}  // namespace ur_ros_rtde
