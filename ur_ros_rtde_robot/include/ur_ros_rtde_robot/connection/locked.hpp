#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace ur_ros_rtde {

/// A recursive lock whose wait has a limit, given in the order of asking: a thread that calls in a loop does
/// not keep the others out. (std::recursive_timed_mutex waits with pthread_mutex_clocklock, which
/// ThreadSanitizer of the compilers we support does not know.)
class InterfaceLock {
 public:
  /// False when another thread still held it after `limit`.
  bool try_lock_for(std::chrono::milliseconds limit);
  void unlock();

 private:
  std::mutex mutex_;
  std::condition_variable released_;
  std::deque<std::thread::id> waiting_;
  std::thread::id owner_;
  unsigned depth_ = 0;
};

/// Takes `lock`, waiting up to `limit`; throws RobotError (busy) naming `what` when it cannot be had.
std::unique_ptr<InterfaceLock, void (*)(InterfaceLock *)> acquire(InterfaceLock & lock, const char * what,
                                                                  std::chrono::milliseconds limit);

/// One of ur_rtde's interfaces, none of which is thread-safe. `operator->` holds the interface's lock for one
/// call (execute-around pointer): `robot.control()->moveL(pose, speed, acceleration, true);` A call that
/// finds another thread's call still running after `limit` throws RobotError (busy). The interface stays
/// alive while a Locked refers to it, but may lose its connection: get a new one from the robot for each use,
/// do not keep it.
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
  /// Holds the lock for as long as the returned value lives, for several calls that belong together. Never
  /// wait meanwhile.
  Call hold() const { return Call(*this); }

 private:
  std::shared_ptr<T> object_;
  std::shared_ptr<InterfaceLock> lock_;
  const char * what_;
  std::chrono::milliseconds limit_;
};

}  // namespace ur_ros_rtde
