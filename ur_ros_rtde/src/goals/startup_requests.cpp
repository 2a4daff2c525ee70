#include "ur_ros_rtde/detail/startup_requests.hpp"

namespace ur_ros_rtde {

std::shared_ptr<void> StartupRequests::begin(const std::function<bool()> & may_begin)
{
  const std::lock_guard lock(mutex_);
  if (!may_begin()) {
    return nullptr;
  }
  ++under_way_;
  return {this, [](StartupRequests * requests) { requests->end(); }};
}

bool StartupRequests::are_under_way() const
{
  const std::lock_guard lock(mutex_);
  return under_way_ > 0;
}

bool StartupRequests::wait_until_none(std::chrono::milliseconds timeout)
{
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, timeout, [this] { return under_way_ == 0; });
}

void StartupRequests::end()
{
  {
    const std::lock_guard lock(mutex_);
    --under_way_;
  }
  ended_.notify_all();
}

}  // namespace ur_ros_rtde
