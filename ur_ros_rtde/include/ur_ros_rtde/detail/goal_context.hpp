#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde_robot/motion/arbiter.hpp"

namespace ur_ros_rtde {

/// What belongs to one goal from its acceptance check to its result: the request to stop it and the lease
/// of the resource that it uses. Thread-safe, except for preempted_goal.
class GoalContext : public std::enable_shared_from_this<GoalContext> {
 public:
  const std::shared_ptr<StopRequest> stop_request = std::make_shared<StopRequest>();
  /// The goal that this one preempted: "/move_j, goal 3f0c12ab". Empty: none. Used by the goal's thread only.
  std::string preempted_goal;

  /// Keeps the lease until release_lease(). A goal that was asked to stop before its start does not keep it.
  void hold(Lease lease);
  bool holds_lease() const;
  void release_lease();

  /// From now on a request to stop leaves the lease to the goal's thread, which stops the arm first.
  void set_started();
  /// Asks the goal to stop. A goal that has not started releases its lease at once.
  void stop(StopReason reason);

 private:
  mutable std::mutex mutex_;
  Lease lease_;
  bool started_ = false;
};

}  // namespace ur_ros_rtde
