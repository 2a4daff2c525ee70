#include "motion/path/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {
namespace {

constexpr double epsilon = 1e-12;

/// Speed changes between the blend at the start and the blend at the end.
struct CruisePhases {
  double first_acceleration;  ///< to `cruise_speed`; negative: deceleration
  double cruise_speed;        ///< between the two changes
  double last_deceleration;   ///< from `cruise_speed` to `exit_speed`
  double exit_speed;          ///< where the blend at the end begins
  bool feasible;              ///< within the given acceleration
};

/// From `entry_speed` over `distance` to `max_exit_speed` at most.
CruisePhases plan_cruise(double entry_speed, double speed, double acceleration, double max_exit_speed,
                         double distance)
{
  const double min_speed =
      std::sqrt(std::max(0.0, entry_speed * entry_speed - 2.0 * acceleration * distance));
  if (min_speed > max_exit_speed + epsilon) {
    const double required_acceleration =
        0.5 * (entry_speed * entry_speed - max_exit_speed * max_exit_speed) / std::max(distance, epsilon);
    return {-required_acceleration, max_exit_speed, required_acceleration, max_exit_speed, false};
  }
  if (entry_speed > speed) {
    const double cruise_speed = std::max(speed, min_speed);
    return {-acceleration, cruise_speed, acceleration, std::min(cruise_speed, max_exit_speed), true};
  }
  const double reachable_speed =
      std::min(speed, std::sqrt(entry_speed * entry_speed + 2.0 * acceleration * distance));
  if (reachable_speed <= max_exit_speed) {
    return {acceleration, reachable_speed, acceleration, reachable_speed, true};
  }
  const double peak = std::sqrt(acceleration * distance +
                                0.5 * (entry_speed * entry_speed + max_exit_speed * max_exit_speed));
  return {acceleration, std::min(speed, peak), acceleration, max_exit_speed, true};
}

}  // namespace

SpeedProfile::SpeedProfile(const ProfileConstraints & constraints)
{
  if (!(constraints.length > 0.0)) {
    return;
  }
  double blend_in_acceleration = constraints.acceleration;
  if (constraints.blend_in_time > 0.0) {
    const double time = constraints.blend_in_time;
    blend_in_acceleration = std::min({blend_in_acceleration, constraints.speed / time,
                                      2.0 * constraints.blend_in_distance / (time * time)});
  }
  if (build(constraints, blend_in_acceleration)) {
    return;
  }
  // The path is too short: bisect for the highest feasible acceleration of the blend.
  double feasible = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (feasible + blend_in_acceleration);
    (build(constraints, middle) ? feasible : blend_in_acceleration) = middle;
  }
  build(constraints, feasible);
}

bool SpeedProfile::build(const ProfileConstraints & constraints, double blend_in_acceleration)
{
  const double entry_speed = constraints.start_speed + blend_in_acceleration * constraints.blend_in_time;
  const double blend_in_distance = 0.5 * (constraints.start_speed + entry_speed) * constraints.blend_in_time;
  const double blend_out_limit = std::min(constraints.blend_out_distance, 0.5 * constraints.length);
  // The distance covered during the lead shortens the deceleration.
  const double lead_speed =
      std::min(constraints.speed, std::sqrt(2.0 * constraints.blend_out_acceleration * blend_out_limit));
  const double lead_distance = std::min(constraints.blend_start_lead * lead_speed, 0.5 * blend_out_limit);
  const double blend_out_distance = blend_out_limit - lead_distance;
  const double cruise_distance = constraints.length - blend_in_distance - blend_out_distance;
  if (cruise_distance < 0.0) {
    return false;
  }
  const double max_exit_speed = std::sqrt(2.0 * constraints.blend_out_acceleration * blend_out_distance);
  const CruisePhases cruise =
      plan_cruise(entry_speed, constraints.speed, constraints.acceleration, max_exit_speed, cruise_distance);

  length_ = constraints.length;
  start_speed_ = constraints.start_speed;
  acceleration_ = std::max(constraints.acceleration, std::abs(cruise.first_acceleration));
  phases_ = {};
  phases_[0] = {constraints.blend_in_time, blend_in_acceleration};
  phases_[1] = {std::abs(cruise.cruise_speed - entry_speed) / std::abs(cruise.first_acceleration),
                cruise.first_acceleration};
  phases_[3] = {(cruise.cruise_speed - cruise.exit_speed) / cruise.last_deceleration,
                -cruise.last_deceleration};
  const double speed_change_distance = 0.5 * (entry_speed + cruise.cruise_speed) * phases_[1].duration +
                                       0.5 * (cruise.cruise_speed + cruise.exit_speed) * phases_[3].duration;
  phases_[2].duration = cruise.cruise_speed > epsilon
                            ? std::max(0.0, cruise_distance - speed_change_distance) / cruise.cruise_speed
                            : 0.0;
  finish_with_blend(blend_out_distance, cruise.exit_speed, lead_distance);
  return cruise.feasible || constraints.blend_in_time <= 0.0;
}

void SpeedProfile::finish_with_blend(double distance, double speed, double lead_distance)
{
  const bool blends = distance > 0.0 && speed > epsilon;
  if (blends) {
    phases_[4] = {2.0 * distance / speed, -0.5 * speed * speed / distance};
  }
  duration_ = 0.0;
  for (const Phase & phase : phases_) {
    duration_ += phase.duration;
  }
  blend_start_time_ = duration_ - phases_[4].duration;
  if (blends) {
    blend_start_time_ = std::max(0.0, blend_start_time_ - lead_distance / speed);
  }
}

double SpeedProfile::duration_between_blend_middles(const ProfileConstraints & constraints) const
{
  return duration_ - 0.5 * (constraints.blend_in_time + phases_[4].duration);
}

SpeedProfile SpeedProfile::with_duration(ProfileConstraints constraints, double duration, double speed_limit,
                                         double acceleration_limit)
{
  // A triangular profile needs at least 4 length / duration^2.
  const double min_acceleration = 4.0 * constraints.length / (duration * duration);
  constraints.acceleration =
      std::min(std::max(constraints.acceleration, min_acceleration), acceleration_limit);
  constraints.blend_out_acceleration = constraints.acceleration;
  constraints.speed = speed_limit;
  SpeedProfile best(constraints);
  if (best.duration_between_blend_middles(constraints) >= duration) {
    return best;
  }
  double lower = 0.0, upper = speed_limit;
  for (int i = 0; i < 80; ++i) {
    constraints.speed = 0.5 * (lower + upper);
    const SpeedProfile candidate(constraints);
    const bool in_time = candidate.duration_between_blend_middles(constraints) <= duration;
    (in_time ? upper : lower) = constraints.speed;
    best = in_time ? candidate : best;
  }
  return best;
}

SpeedProfile::Sample SpeedProfile::sample(double time) const
{
  if (time >= duration_) {
    return {length_, 0.0};
  }
  Sample sample{0.0, start_speed_};
  double left = std::max(0.0, time);
  for (const Phase & phase : phases_) {
    const double passed = std::min(left, phase.duration);
    sample.distance += passed * (sample.speed + 0.5 * phase.acceleration * passed);
    sample.speed += phase.acceleration * passed;
    left -= passed;
  }
  return {std::min(sample.distance, length_), std::max(0.0, sample.speed)};
}

}  // namespace ur_simulator
