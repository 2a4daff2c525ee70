#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "motion/motion_tracker.hpp"
#include "program/control_program_manager.hpp"
#include "program/script_watch.hpp"
#include "ur_ros_rtde_robot/program/script.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Runs scripts: programs in the place of the control program, secondary programs beside it.
class ScriptRunner {
 public:
  ScriptRunner(const RobotOptions & options, const StateReceiver & state, const MotionTracker & tracker,
               RtdeInterfaces & interfaces, ControlProgramManager & manager);

  ScriptReport run(const std::string & script, const ScriptOptions & options);

 private:
  ScriptReport run_program(const script::Program & program, ScriptWatch & watch);
  /// Stops the program, which decelerates the arm, and waits until both stand still.
  Status stop() const;
  /// Of the arm; of the program, too.
  bool wait_for_standstill(bool of_program) const;
  std::string preamble() const;

  const RobotOptions options_;
  const StateReceiver & state_;
  const MotionTracker & tracker_;
  RtdeInterfaces & interfaces_;
  ControlProgramManager & manager_;
  /// Tells the scripts of this process from each other and from those of others.
  std::atomic<std::uint32_t> next_id_;
};

}  // namespace ur_ros_rtde
