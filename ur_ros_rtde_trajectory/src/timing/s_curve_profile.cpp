#include "timing/s_curve_profile.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

// Limits of the motion along the line.
struct LineLimits {
  double velocity, acceleration, jerk;
};

LineLimits path_limits(const Joints & direction, const Limits & limits)
{
  const Joints direction_magnitude = direction.abs().max(1e-300);
  return {(limits.velocity / direction_magnitude).minCoeff(),
          (limits.acceleration / direction_magnitude).minCoeff(),
          (limits.jerk / direction_magnitude).minCoeff()};
}

// Acceleration from rest: jerk, constant acceleration, jerk back to zero acceleration.
struct Ramp {
  double jerk_time = 0.0;  // duration of each of the two jerk phases
  double total_time = 0.0;
  double acceleration = 0.0;
};

Ramp ramp_to(double speed, const LineLimits & limits)
{
  const bool reaches = speed * limits.jerk > limits.acceleration * limits.acceleration;
  Ramp ramp;
  ramp.acceleration = reaches ? limits.acceleration : std::sqrt(speed * limits.jerk);
  ramp.jerk_time = ramp.acceleration / limits.jerk;  // 0 without a jerk limit
  ramp.total_time = ramp.jerk_time + speed / ramp.acceleration;
  return ramp;
}

// Highest speed of a motion from rest to rest over `length`.
double peak_speed(double length, const LineLimits & limits)
{
  const double settle = limits.acceleration * limits.acceleration / limits.jerk;  // acceleration * jerk time
  const double full = 0.5 * (-settle + std::sqrt(settle * settle + 4.0 * limits.acceleration * length));
  const bool reaches = full >= settle;
  const double speed = reaches ? full : std::cbrt(0.25 * length * length * limits.jerk);
  return std::min(speed, limits.velocity);
}

}  // namespace

void append_s_curve_profile(Motion & motion, std::size_t piece, const Limits & limits)
{
  const PathPiece & line = motion.path->pieces[piece];
  const LineLimits line_limits = path_limits(line.c[1] / line.length, limits);
  const double speed = peak_speed(line.length, line_limits);
  const Ramp ramp = ramp_to(speed, line_limits);
  const double steady = std::max(0.0, ramp.total_time - 2.0 * ramp.jerk_time);
  const double cruise = std::max(0.0, line.length / speed - ramp.total_time);
  const double a = ramp.acceleration;
  const double phases[7][3] = {// duration, acceleration at the start and at the end
                               {ramp.jerk_time, 0, a}, {steady, a, a},          {ramp.jerk_time, a, 0},
                               {cruise, 0, 0},         {ramp.jerk_time, 0, -a}, {steady, -a, -a},
                               {ramp.jerk_time, -a, 0}};
  PathState state;
  for (const auto & [time, from, to] : phases) {
    if (time <= 0.0) {
      continue;
    }
    state.a = from;
    state.j = (to - from) / time;
    motion.append(piece, time, state);
    state.u += time * (state.v + time * (from / 3.0 + to / 6.0));
    state.v += 0.5 * (from + to) * time;
  }
}

}  // namespace ur_ros_rtde::trajectory
