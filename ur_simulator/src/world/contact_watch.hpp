#pragma once

#include <array>
#include <cstddef>

#include "common/types.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// What tool_contact() knows: how the force at the tool changed in the last cycles, against what it was in
/// free space. A payload that is set anew, or another sensor, is no contact.
class ContactWatch {
 public:
  explicit ContactWatch(double cycle_time) : cycle_time_(cycle_time) {}

  /// Once a cycle: the force on the tool, not zeroed, base axes.
  void record(const Vector3 & force, const ControllerState & state);
  /// Cycles back to just before the contact, 0 without one. A contact holds the tool up against `direction`
  /// (of any length; zero: whichever) by more than the change of `threshold` N, and more than `least_force`.
  std::size_t steps(const Vector3 & direction, double threshold) const;

  static constexpr double least_force = 5.0;  ///< N; not published, an estimate
  static constexpr std::size_t capacity = 1024;

 private:
  bool another_measurement(const ControllerState & state) const;

  double cycle_time_;
  Vector3 free_ = Vector3::Zero();  ///< the reading in free space, followed slowly
  std::array<Vector3, capacity> forces_{};
  std::size_t count_ = 0;
  double settled_at_ = 0.0;  ///< s: until then the reading follows a change of what is measured
  double mass_ = 0.0;
  Vector3 center_of_gravity_ = Vector3::Zero();
  bool external_ = false;
};

}  // namespace ur_simulator
