#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "motion/permit.hpp"
#include "ur_ros_rtde_robot/motion/lease.hpp"

namespace ur_ros_rtde {

/// Grants each resource to one holder at a time. Thread-safe. Leases may outlive the arbiter.
class Arbiter {
 public:
  /// Success if the claim may be granted for reasons beyond other holders. Called under the arbiter's lock:
  /// must not wait, and not call the arbiter.
  using Admission = std::function<Expected<Generation>()>;

  Arbiter();
  /// busy, with the holder's name and id, if a conflicting resource is held.
  Expected<Lease> acquire(Claim claim, const Admission & admit);
  /// Called if a claim is not admitted. Waits for the end of the cause, and returns true if it has ended.
  using Retry = std::function<bool()>;
  /// Preempts the current holders and those that wait, and waits until `deadline`, or until `stop`, for them;
  /// then busy as above.
  Expected<Lease> acquire_preempting(const Claim & claim, const Admission & admit, const Retry & retry,
                                     Permit::Clock::time_point deadline, const std::stop_token & stop);
  /// The holder that a claim on `resource` would conflict with.
  std::shared_ptr<const Permit> holder(Resource resource) const;
  /// All holders that may move the arm.
  std::vector<std::shared_ptr<Permit>> arm_holders() const;
  /// Waits until no holder is left that may move the arm and whose permit is revoked. False after `timeout`.
  bool wait_for_revoked_holders(std::chrono::milliseconds timeout) const;

 private:
  std::shared_ptr<Lease::Table> table_;
};

}  // namespace ur_ros_rtde
