#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

// For the driver

/// A recursive mutex with timeout that is granted in order of request, so that a thread which locks it in a
/// loop does not starve others. (std::recursive_timed_mutex uses pthread_mutex_clocklock, which the
/// ThreadSanitizer of the supported compilers does not know.)
class InterfaceLock {
 public:
  enum class Place { last, first };  ///< in the queue of the waiting threads

  /// False if another thread still holds the lock after `timeout`.
  [[nodiscard]] bool try_lock_for(std::chrono::milliseconds timeout, Place place = Place::last);
  /// Once for each successful try_lock_for().
  void unlock();

 private:
  std::mutex mutex_;
  std::condition_variable released_;
  std::deque<std::thread::id> waiting_;
  std::thread::id owner_;
  unsigned depth_ = 0;
};

/// An InterfaceLock that is held. Null: it is not.
using HeldLock = std::unique_ptr<InterfaceLock, void (*)(InterfaceLock *)>;
HeldLock held(InterfaceLock * lock);

/// Locks `lock`; throws RobotError (busy), which names `what`, if that takes longer than `timeout`.
HeldLock acquire(InterfaceLock & lock, const char * what, std::chrono::milliseconds timeout,
                 InterfaceLock::Place place = InterfaceLock::Place::last);

// For plugins

/// Thread-safe access to one of ur_rtde's interfaces, which are not thread-safe themselves. `operator->`
/// holds the interface's lock for one call (execute-around pointer): `robot.control(lease)->moveL(pose,
/// speed, acceleration, true);` A call throws RobotError (busy) if the call of another thread is still
/// running after `timeout`, and with the reason if the caller may no longer command the robot. The interface
/// stays alive while a Locked refers to it, but may lose its connection: get a Locked from the robot for each
/// use instead of storing it.
template <class T>
class Locked {
 public:
  /// Evaluated with the lock held, so that no call begins after a stop has taken the lock. What it returns is
  /// kept for as long as the call lasts, which must end before the robot.
  using Permission = std::function<Expected<std::shared_ptr<void>>()>;

  /// One call, or several during its lifetime: holds the lock.
  class Call {
   public:
    Call(const Locked & locked)
        : object_(locked.object_), held_(acquire(*locked.lock_, locked.what_, locked.timeout_, locked.place_))
    {
      if (locked.permission_) {
        auto permitted = locked.permission_();
        if (!permitted) {
          throw RobotError(permitted.error());
        }
        permitted_ = *std::move(permitted);
      }
    }
    T * operator->() const { return object_.get(); }
    T & operator*() const { return *object_; }

   private:
    std::shared_ptr<T> object_;
    HeldLock held_;
    std::shared_ptr<void> permitted_;  ///< last: ends before the lock is released
  };

  Locked(std::shared_ptr<T> object, std::shared_ptr<InterfaceLock> lock, const char * what,
         std::chrono::milliseconds timeout = std::chrono::seconds(5))
      : object_(std::move(object)), lock_(std::move(lock)), what_(what), timeout_(timeout)
  {
  }

  /// The same interface for a caller that may use it as long as `permission` succeeds.
  Locked permitted_by(Permission permission) const
  {
    Locked result = *this;
    result.permission_ = std::move(permission);
    return result;
  }

  /// The same interface for a caller that goes before all who wait, and waits for the call under way at most
  /// for `timeout`.
  Locked before_others(std::chrono::milliseconds timeout) const
  {
    Locked result = *this;
    result.timeout_ = timeout;
    result.place_ = InterfaceLock::Place::first;
    return result;
  }

  Call operator->() const { return Call(*this); }
  /// Holds the lock for the lifetime of the returned value, for several calls that belong together. Do not
  /// wait while holding it.
  Call hold() const { return Call(*this); }

 private:
  std::shared_ptr<T> object_;
  std::shared_ptr<InterfaceLock> lock_;
  const char * what_;
  std::chrono::milliseconds timeout_;
  InterfaceLock::Place place_ = InterfaceLock::Place::last;
  Permission permission_;
};

}  // namespace ur_ros_rtde
