#include "world/contact_watch.hpp"

#include <algorithm>

namespace ur_simulator {
namespace {

constexpr double drift = 2.5;          // N: a smaller change is taken for drift …
constexpr double drift_time = 1.0;     // s: … and followed
constexpr double settling_time = 0.1;  // s
constexpr double onset = 1.0;          // N, several times the noise of the filtered reading
constexpr std::size_t filter_lag = 2;  // cycles by which the filtered reading lags behind

double against(const Vector3 & force, const Vector3 & direction)
{
  const double length = direction.norm();
  return length < 1e-9 ? force.norm() : -force.dot(direction) / length;
}

}  // namespace

bool ContactWatch::another_measurement(const ControllerState & state) const
{
  return count_ == 0 || state.payload.mass != mass_ ||
         state.payload.center_of_gravity != center_of_gravity_ || state.external_sensor.enabled != external_;
}

void ContactWatch::record(const Vector3 & force, const ControllerState & state)
{
  if (another_measurement(state)) {
    settled_at_ = state.timestamp + settling_time;
    mass_ = state.payload.mass;
    center_of_gravity_ = state.payload.center_of_gravity;
    external_ = state.external_sensor.enabled;
  }
  if (state.timestamp <= settled_at_) {
    free_ = force;
    forces_.fill(force);
  }
  const Vector3 change = force - free_;
  if (change.norm() < drift) {
    free_ += change * (cycle_time_ / drift_time);
  }
  forces_[count_++ % capacity] = force;
}

std::size_t ContactWatch::steps(const Vector3 & direction, double threshold) const
{
  if (count_ == 0) {
    return 0;
  }
  const auto change = [&](std::size_t back) {
    return against(forces_[(count_ - 1 - back) % capacity] - free_, direction);
  };
  if (change(0) < std::max(threshold, least_force)) {
    return 0;
  }
  const std::size_t known = std::min(count_, capacity) - 1;
  std::size_t back = 1;
  while (back < known && change(back) > onset) {
    ++back;
  }
  return std::min(back + filter_lag, known);
}

}  // namespace ur_simulator
