#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "ur_ros_rtde_robot/motion/lease.hpp"

namespace ur_ros_rtde {

/// The permission of one holder of a resource to command the arm. It ends with its generation, or when a stop
/// revokes it. Thread-safe.
class Permit {
 public:
  using Clock = std::chrono::steady_clock;

  Permit(Claim claim, Generation generation) : claim_(std::move(claim)), generation_(generation) {}

  const Claim & claim() const { return claim_; }

  Generation generation() const
  {
    const std::lock_guard lock(mutex_);
    return generation_;
  }
  /// For the generation that the holder itself has begun, by running a script.
  void renew(const Generation & generation)
  {
    const std::lock_guard lock(mutex_);
    generation_ = generation;
  }

  /// True for the first caller, which then stops the arm.
  bool revoke(Error why)
  {
    const std::lock_guard lock(mutex_);
    if (revoked_) {
      return false;
    }
    revoked_ = std::move(why);
    return true;
  }
  /// Why the holder may no longer command the arm. Empty: it may.
  std::optional<Error> revoked() const
  {
    const std::lock_guard lock(mutex_);
    return revoked_;
  }

  /// The holder streams a motion that it can brake by itself, along its path.
  void set_brakes_itself(bool brakes)
  {
    const std::lock_guard lock(mutex_);
    brakes_itself_ = brakes;
    last_braking_.reset();
  }
  bool brakes_itself() const
  {
    const std::lock_guard lock(mutex_);
    return brakes_itself_;
  }
  /// The holder has just sent a setpoint that brakes.
  void set_braking()
  {
    const std::lock_guard lock(mutex_);
    last_braking_ = Clock::now();
  }
  /// When the holder has sent the newest setpoint that brakes. Empty: it has not begun to brake.
  std::optional<Clock::time_point> last_braking() const
  {
    const std::lock_guard lock(mutex_);
    return last_braking_;
  }

 private:
  const Claim claim_;
  mutable std::mutex mutex_;
  Generation generation_;
  std::optional<Error> revoked_;
  bool brakes_itself_ = false;
  std::optional<Clock::time_point> last_braking_;
};

}  // namespace ur_ros_rtde
