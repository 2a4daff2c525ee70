#pragma once

#include <array>
#include <cstddef>

#include "common/types.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Contact detection of URScript's tool_contact(): compares the tool force of the last cycles with the force
/// in free space. A change of the payload or of the sensor is no contact.
class ContactDetector {
 public:
  explicit ContactDetector(double cycle_time) : cycle_time_(cycle_time) {}

  /// Call once per cycle with the force on the tool, not zeroed, in the base frame.
  void record(const Vector3 & force, const ControllerState & state);
  /// Number of cycles since just before the contact, 0 if there is no contact. In a contact the force against
  /// `direction` (any length; zero: any direction) has changed by more than `threshold` N and more than
  /// `min_force`.
  std::size_t cycles_since_contact(const Vector3 & direction, double threshold) const;

  static constexpr double min_force = 5.0;  ///< N; not published, an estimate
  static constexpr std::size_t capacity = 1024;

 private:
  bool measurement_changed(const ControllerState & state) const;

  double cycle_time_;
  Vector3 free_space_force_ = Vector3::Zero();  ///< slowly filtered reading in free space
  std::array<Vector3, capacity> forces_{};
  std::size_t count_ = 0;
  double settled_at_ = 0.0;  ///< s; until then the reading settles after a change of payload or sensor
  double mass_ = 0.0;
  Vector3 center_of_gravity_ = Vector3::Zero();
  bool external_ = false;
};

}  // namespace ur_simulator
