#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Resource that a command holds exclusively while it runs. `script` replaces the control program and
/// therefore excludes motion as well; `none` excludes nothing.
enum class Resource { none, motion, io, script };

const char * to_string(Resource resource);

struct Claim {
  Resource resource = Resource::motion;
  std::string owner;  ///< name shown to users: "move_l"
  std::string id;     ///< goal id; distinguishes commands of the same name
  /// Asks this holder to release the resource; `by` names the new claimant. Called on the claimant's thread:
  /// must request a stop without waiting. Empty: this holder cannot be preempted.
  std::function<void(const std::string & by)> preempt;
};

class Arbiter;

/// The right to use a resource. Released on destruction; movable.
class Lease {
 public:
  Lease() = default;
  Lease(Lease && other) noexcept;
  Lease & operator=(Lease && other) noexcept;
  ~Lease();
  explicit operator bool() const { return state_ != nullptr; }
  void release();

 private:
  friend class Arbiter;
  struct State;
  explicit Lease(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

/// Grants each resource to one holder at a time. Thread-safe. Leases may outlive the arbiter.
class Arbiter {
 public:
  struct Holder {
    std::string owner;
    std::string id;
  };

  Arbiter();
  /// busy, with the holder's name and id, if a conflicting resource is held.
  Expected<Lease> acquire(Claim claim);
  /// Preempts the current holders and waits up to `limit` for them; then busy as above.
  Expected<Lease> acquire_preempting(Claim claim, std::chrono::milliseconds limit);
  std::optional<Holder> holder(Resource resource) const;

 private:
  struct Table;
  std::shared_ptr<Table> table_;
  friend class Lease;
};

}  // namespace ur_ros_rtde
