#pragma once

#include <atomic>
#include <cstdint>
#include <string>

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
               RtdeInterfaces & interfaces, ControlProgramManager & manager);

  ScriptReport run(const std::string & script, const ScriptOptions & options);

 private:
  ScriptReport run_program(const script::Program & program, ScriptMonitor & monitor);
  /// Stops the program, which decelerates the arm, and waits until program and arm have stopped.
  Status stop() const;
  bool wait_for_program_end() const;
  std::string preamble() const;

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  RtdeInterfaces & interfaces_;
  ControlProgramManager & manager_;
  /// Makes the markers of scripts unique; starts at random to differ from those of other processes.
  std::atomic<std::uint32_t> next_id_;
};

}  // namespace ur_ros_rtde
