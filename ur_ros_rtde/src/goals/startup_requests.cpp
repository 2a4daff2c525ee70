#include "ur_ros_rtde/detail/startup_requests.hpp"

namespace ur_ros_rtde {
namespace {

/// Of the samples behind the dashboard server.
constexpr std::chrono::milliseconds longest_delay{100};

}  // namespace

std::shared_ptr<void> StartupRequests::begin(const std::function<bool()> & may_begin)
{
  const std::lock_guard lock(mutex_);
  if (!may_begin()) {
    return nullptr;
  }
  ++under_way_;
  return {this, [](StartupRequests * requests) { requests->end(); }};
}

bool StartupRequests::may_take_effect() const
{
  const std::lock_guard lock(mutex_);
  return under_way_ > 0 || std::chrono::steady_clock::now() - last_end_ < longest_delay;
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
    last_end_ = std::chrono::steady_clock::now();
  }
  ended_.notify_all();
}

}  // namespace ur_ros_rtde
