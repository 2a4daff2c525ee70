#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace ur_ros_rtde {

/// A recursive mutex with timeout that is granted in order of request, so that a thread which locks it in a
/// loop does not starve others. (std::recursive_timed_mutex uses pthread_mutex_clocklock, which the
/// ThreadSanitizer of the supported compilers does not know.)
class InterfaceLock {
 public:
  /// False if another thread still holds the lock after `limit`.
  bool try_lock_for(std::chrono::milliseconds limit);
  void unlock();

 private:
  std::mutex mutex_;
  std::condition_variable released_;
  std::deque<std::thread::id> waiting_;
  std::thread::id owner_;
  unsigned depth_ = 0;
};

/// Locks `lock`; throws RobotError (busy), which names `what`, if that takes longer than `limit`.
std::unique_ptr<InterfaceLock, void (*)(InterfaceLock *)> acquire(InterfaceLock & lock, const char * what,
                                                                  std::chrono::milliseconds limit);

/// Thread-safe access to one of ur_rtde's interfaces, which are not thread-safe themselves. `operator->`
/// holds the interface's lock for one call (execute-around pointer): `robot.control()->moveL(pose, speed,
/// acceleration, true);` A call throws RobotError (busy) if the call of another thread is still running after
/// `limit`. The interface stays alive while a Locked refers to it, but may lose its connection: get a Locked
/// from the robot for each use instead of storing it.
template <class T>
class Locked {
 public:
  class Call {
   public:
    Call(const Locked & locked)
        : object_(locked.object_), held_(acquire(*locked.lock_, locked.what_, locked.limit_))
    {
    }
    T * operator->() const { return object_.get(); }
    T & operator*() const { return *object_; }

   private:
    std::shared_ptr<T> object_;
    std::unique_ptr<InterfaceLock, void (*)(InterfaceLock *)> held_;
  };

  Locked(std::shared_ptr<T> object, std::shared_ptr<InterfaceLock> lock, const char * what,
         std::chrono::milliseconds limit = std::chrono::seconds(5))
      : object_(std::move(object)), lock_(std::move(lock)), what_(what), limit_(limit)
  {
  }

  Call operator->() const { return Call(*this); }
  /// Holds the lock for the lifetime of the returned value, for several calls that belong together. Do not
  /// wait while holding it.
  Call hold() const { return Call(*this); }

 private:
  std::shared_ptr<T> object_;
  std::shared_ptr<InterfaceLock> lock_;
  const char * what_;
  std::chrono::milliseconds limit_;
};

}  // namespace ur_ros_rtde
