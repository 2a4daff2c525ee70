#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "connection/rtde/rtde_interfaces.hpp"
#include "motion/motion_tracker.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Stops the arm: with the stop command of each kind of motion, else by stopping the robot program, else by
/// ending the heartbeat, so that the program's watchdog stops it. Concurrent stops run one after the other.
class MotionStopper {
 public:
  MotionStopper(std::string address, const StateReceiver & state, RtdeInterfaces & interfaces,
                const MotionTracker & tracker)
      : address_(std::move(address)), state_(state), interfaces_(interfaces), tracker_(tracker)
  {
  }

  Expected<StopReport> stop(const StopOptions & options);

 private:
  bool is_moving() const;
  /// True if the control program has executed all stop commands.
  bool command_stop(const StopOptions & options);
  /// False after `limit` or if the connection is lost.
  bool wait_for_standstill(std::chrono::milliseconds limit) const;
  tl::unexpected<Error> link_lost() const;

  const std::string address_;
  const StateReceiver & state_;
  RtdeInterfaces & interfaces_;
  const MotionTracker & tracker_;
  std::mutex mutex_;
};

/// Sends the dashboard command `stop` on a separate connection, so that it works while the shared client is
/// waiting. Fails with the robot's answer.
Status stop_program(const std::string & address, std::chrono::milliseconds limit);

}  // namespace ur_ros_rtde
