#include "world/contact_detector.hpp"

#include <algorithm>

namespace ur_simulator {
namespace {

constexpr double max_drift = 2.5;            // N: a smaller change counts as drift
constexpr double drift_time_constant = 1.0;  // s
constexpr double settling_time = 0.1;        // s
constexpr double onset_force = 1.0;          // N, several times the noise of the filtered reading
constexpr std::size_t filter_lag = 2;        // cycles

double opposing_force(const Vector3 & force, const Vector3 & direction)
{
  const double length = direction.norm();
  return length < 1e-9 ? force.norm() : -force.dot(direction) / length;
}

}  // namespace

bool ContactDetector::measurement_changed(const ControllerState & state) const
{
  return count_ == 0 || state.payload.mass != mass_ ||
         state.payload.center_of_gravity != center_of_gravity_ || state.external_sensor.enabled != external_;
}

void ContactDetector::record(const Vector3 & force, const ControllerState & state)
{
  if (measurement_changed(state)) {
    settled_at_ = state.timestamp + settling_time;
    mass_ = state.payload.mass;
    center_of_gravity_ = state.payload.center_of_gravity;
    external_ = state.external_sensor.enabled;
  }
  if (state.timestamp <= settled_at_) {
    free_space_force_ = force;
    forces_.fill(force);
  }
  const Vector3 change = force - free_space_force_;
  if (change.norm() < max_drift) {
    free_space_force_ += change * (cycle_time_ / drift_time_constant);
  }
  forces_[count_++ % capacity] = force;
}

std::size_t ContactDetector::cycles_since_contact(const Vector3 & direction, double threshold) const
{
  if (count_ == 0) {
    return 0;
  }
  const auto change = [&](std::size_t age) {
    return opposing_force(forces_[(count_ - 1 - age) % capacity] - free_space_force_, direction);
  };
  if (change(0) < std::max(threshold, min_force)) {
    return 0;
  }
  const std::size_t recorded = std::min(count_, capacity) - 1;
  std::size_t age = 1;
  while (age < recorded && change(age) > onset_force) {
    ++age;
  }
  return std::min(age + filter_lag, recorded);
}

}  // namespace ur_simulator
