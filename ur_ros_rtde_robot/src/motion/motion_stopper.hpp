#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "connection/rtde_interfaces.hpp"
#include "motion/motion_tracker.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Brings the arm to rest: by the stop that belongs to each kind of motion under way, else by stopping the
/// robot program, else by leaving it to the program's watchdog. One stop at a time.
class MotionStopper {
 public:
  MotionStopper(std::string address, const StateReceiver & state, RtdeInterfaces & interfaces,
                const MotionTracker & tracker)
      : address_(std::move(address)), state_(state), interfaces_(interfaces), tracker_(tracker)
  {
  }

  Expected<StopReport> stop(const StopOptions & options);

 private:
  bool under_way() const;
  /// True when the control program has taken every stop it needed.
  bool command_stop(const StopOptions & options);
  /// False also when the link is lost meanwhile.
  bool wait_for_standstill(std::chrono::milliseconds limit) const;
  tl::unexpected<Error> link_lost() const;

  const std::string address_;
  const StateReceiver & state_;
  RtdeInterfaces & interfaces_;
  const MotionTracker & tracker_;
  std::mutex mutex_;
};

/// The dashboard command `stop`, over a connection of its own: it works while the shared client waits for
/// something. Fails with the robot's answer.
Status stop_program(const std::string & address, std::chrono::milliseconds limit);

}  // namespace ur_ros_rtde
