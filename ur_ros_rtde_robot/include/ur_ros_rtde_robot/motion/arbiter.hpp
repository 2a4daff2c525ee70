#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// What a command needs for itself while it runs. `script` replaces the control program and so excludes
/// motion, too; `none` excludes nothing.
enum class Resource { none, motion, io, script };

const char * to_string(Resource resource);

struct Claim {
  Resource resource = Resource::motion;
  std::string owner;  ///< as users know it: "move_l"
  std::string id;     ///< tells it from others of the same name: the goal's id
  /// Asks this holder to give way; `by` names who wants to go on. Called from the other's thread: request a
  /// stop, do not wait. None: this holder does not give way.
  std::function<void(const std::string & by)> preempt;
};

class Arbiter;

/// The right to use a resource, given back on destruction. Movable.
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

/// One user of a resource at a time. Thread-safe. Leases may outlive the arbiter.
class Arbiter {
 public:
  struct Holder {
    std::string owner;
    std::string id;
  };

  Arbiter();
  /// Refused (busy) with the holder's name and id.
  Expected<Lease> acquire(Claim claim);
  /// Asks whoever is in the way to give way and waits for it up to `limit`; then refused as above.
  Expected<Lease> acquire_preempting(Claim claim, std::chrono::milliseconds limit);
  std::optional<Holder> holder(Resource resource) const;

 private:
  struct Table;
  std::shared_ptr<Table> table_;
  friend class Lease;
};

}  // namespace ur_ros_rtde
