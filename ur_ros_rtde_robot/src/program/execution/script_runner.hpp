#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "motion/motion_stopper.hpp"
#include "motion/motion_tracker.hpp"
#include "program/control_program_manager.hpp"
#include "program/execution/script_monitor.hpp"
#include "ur_ros_rtde_robot/program/script.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Runs scripts: programs in place of the control program, secondary programs beside it.
class ScriptRunner {
 public:
  ScriptRunner(const RobotOptions & options, const StateReceiver & state, const MotionTracker & tracker,
               StartedActivities & activities, MotionStopper & stopper, ControlProgramManager & manager,
               std::function<Generation()> generation, std::function<bool()> has_lost_control);

  /// `holder`: of Resource::script; may be null for a secondary program.
  ScriptReport run(Permit * holder, const std::string & script, const ScriptOptions & options);
  /// Number of control programs that have yielded to a script, and of scripts that have come to their end.
  std::uint32_t ended_programs() const { return ended_programs_; }

 private:
  ScriptReport run_program(Permit & holder, const script::Program & program, ScriptMonitor & monitor);
  ScriptReport monitor_program(Permit & holder, const script::Program & program, ScriptMonitor & monitor);
  std::string preamble() const;
  /// If the watchdog of the script has ended it, the controller does not say why.
  void explain(ScriptReport & report) const;

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  StartedActivities & activities_;
  MotionStopper & stopper_;
  ControlProgramManager & manager_;
  const std::function<Generation()> generation_;
  const std::function<bool()> has_lost_control_;  ///< RtdeInterfaces::has_lost_control()
  /// Makes the markers of scripts unique; starts at random to differ from those of other processes.
  std::atomic<std::uint32_t> next_id_;
  std::atomic<std::uint32_t> ended_programs_ = 0;
};

}  // namespace ur_ros_rtde
