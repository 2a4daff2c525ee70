#include "ur_ros_rtde/detail/goal_context.hpp"

namespace ur_ros_rtde {

void GoalContext::hold(Lease lease)
{
  const std::lock_guard lock(mutex_);
  if (started_ || !stop_request->reason()) {
    lease_ = std::move(lease);
  }
}

bool GoalContext::holds_lease() const
{
  const std::lock_guard lock(mutex_);
  return static_cast<bool>(lease_);
}

void GoalContext::release_lease()
{
  const std::lock_guard lock(mutex_);
  lease_.release();
}

void GoalContext::set_started()
{
  const std::lock_guard lock(mutex_);
  started_ = true;
}

void GoalContext::stop(StopReason reason)
{
  stop_request->request(std::move(reason));
  const std::lock_guard lock(mutex_);
  if (!started_) {
    lease_.release();
  }
}

}  // namespace ur_ros_rtde
