#include "ur_ros_rtde_robot/connection/locked.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

bool InterfaceLock::try_lock_for(std::chrono::milliseconds timeout, Place place)
{
  const auto self = std::this_thread::get_id();
  std::unique_lock lock(mutex_);
  if (depth_ != 0 && owner_ == self) {
    ++depth_;
    return true;
  }
  waiting_.insert(place == Place::first ? waiting_.begin() : waiting_.end(), self);
  const bool mine =
      released_.wait_for(lock, timeout, [&] { return depth_ == 0 && waiting_.front() == self; });
  waiting_.erase(std::find(waiting_.begin(), waiting_.end(), self));
  if (mine) {
    owner_ = self;
    depth_ = 1;
  } else {
    lock.unlock();
    released_.notify_all();  // the next thread in the queue may have waited for this one
  }
  return mine;
}

void InterfaceLock::unlock()
{
  {
    const std::lock_guard lock(mutex_);
    if (--depth_ != 0) {
      return;
    }
    owner_ = {};
  }
  released_.notify_all();
}

HeldLock held(InterfaceLock * lock)
{
  return {lock, [](InterfaceLock * locked) { locked->unlock(); }};
}

HeldLock acquire(InterfaceLock & lock, const char * what, std::chrono::milliseconds timeout,
                 InterfaceLock::Place place)
{
  if (!lock.try_lock_for(timeout, place)) {
    throw RobotError(
        {ErrorCode::busy,
         fmt::format("another call of the {} has been running for {} ms: try again when it has ended, or "
                     "use the asynchronous form of that call",
                     what, timeout.count())});
  }
  return held(&lock);
}

}  // namespace ur_ros_rtde
