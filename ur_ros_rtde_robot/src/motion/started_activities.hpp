#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "connection/rtde/input_registers.hpp"
#include "connection/rtde/rtde_interfaces.hpp"
#include "motion/motion_tracker.hpp"
#include "motion/permit.hpp"
#include "ur_ros_rtde_robot/motion/activity.hpp"

namespace ur_ros_rtde {

/// What has been started on the robot and not ended: the only definition, for the end of goals and for stops.
/// Thread-safe.
class StartedActivities {
 public:
  StartedActivities(const RtdeInterfaces & interfaces, const InputRegisters & registers,
                    const MotionTracker & tracker)
      : interfaces_(interfaces), registers_(registers), tracker_(tracker)
  {
  }

  Activities now() const;
  /// Number of moves that have been sent over the present connection, also of those that have ended.
  std::uint32_t sent_moves() const;

  /// A call of the holder of `permit`, which may start something, until the end of the returned object. To be
  /// used before the permit is checked: a stop that revokes it afterwards finds the call.
  std::shared_ptr<void> begin_call(std::shared_ptr<const Permit> permit);

  /// A script that runs, or is about to run, in place of the control program.
  class Script {
   public:
    /// In which a controller that has received a script begins to execute it.
    static constexpr std::chrono::milliseconds begin_limit{3000};

    /// `fence` makes it impossible to send the script: what has not been sent is not executed. Must not wait.
    Script(StartedActivities & activities, std::function<void()> fence);
    ~Script();
    Script(const Script &) = delete;
    Script & operator=(const Script &) = delete;
    /// The controller has begun to execute it, or never will.
    void set_compiled() { activities_.script_compiled_ = true; }

   private:
    StartedActivities & activities_;
  };
  void fence_script() const;
  bool script_compiled() const { return script_compiled_; }

 private:
  /// Activity::call, if there is one.
  Activities calls() const;

  const RtdeInterfaces & interfaces_;
  const InputRegisters & registers_;
  const MotionTracker & tracker_;
  mutable std::mutex mutex_;
  std::list<std::shared_ptr<const Permit>> calls_;
  std::function<void()> fence_;  ///< empty: no script
  std::atomic<bool> script_compiled_ = false;
};

}  // namespace ur_ros_rtde
