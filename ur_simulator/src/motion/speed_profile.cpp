#include "motion/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {
namespace {

constexpr double small = 1e-12;

/// How speed changes between the end of the ramp and the beginning of the last deceleration.
struct Crossing {
  double first;   ///< acceleration (or deceleration) to `cruise`
  double cruise;  ///< speed between the two changes
  double last;    ///< deceleration from `cruise` to `leave`
  double leave;   ///< speed where the last deceleration begins
  bool possible;  ///< within the acceleration
};

/// From speed `enter` over `room` to at most `stoppable`.
Crossing cross(double enter, double speed, double acceleration, double stoppable, double room)
{
  const double slowest = std::sqrt(std::max(0.0, enter * enter - 2.0 * acceleration * room));
  if (slowest > stoppable + small) {
    const double steeper = 0.5 * (enter * enter - stoppable * stoppable) / std::max(room, small);
    return {-steeper, stoppable, steeper, stoppable, false};
  }
  if (enter > speed) {
    const double cruise = std::max(speed, slowest);
    return {-acceleration, cruise, acceleration, std::min(cruise, stoppable), true};
  }
  const double reach = std::min(speed, std::sqrt(enter * enter + 2.0 * acceleration * room));
  if (reach <= stoppable) {
    return {acceleration, reach, acceleration, reach, true};
  }
  const double peak = std::sqrt(acceleration * room + 0.5 * (enter * enter + stoppable * stoppable));
  return {acceleration, std::min(speed, peak), acceleration, stoppable, true};
}

}  // namespace

SpeedProfile::SpeedProfile(const PathTiming & timing)
{
  if (!(timing.length > 0.0)) {
    return;
  }
  double ramp = timing.acceleration;
  if (timing.ramp_time > 0.0) {
    const double time = timing.ramp_time;
    ramp = std::min({ramp, timing.speed / time, 2.0 * timing.ramp_room / (time * time)});
  }
  if (lay(timing, ramp)) {
    return;
  }
  // A path too short to use all of the ramp: the steepest one from which it still ends at its end.
  double possible = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (possible + ramp);
    (lay(timing, middle) ? possible : ramp) = middle;
  }
  lay(timing, possible);
}

bool SpeedProfile::lay(const PathTiming & timing, double ramp)
{
  const double enter = timing.start_speed + ramp * timing.ramp_time;
  const double ramped = 0.5 * (timing.start_speed + enter) * timing.ramp_time;
  const double wished_room = std::min(timing.end_room, 0.5 * timing.length);
  const double stoppable = std::sqrt(2.0 * timing.end_acceleration * wished_room);
  // What is covered between the release and the deceleration comes off the deceleration's way.
  const double late = std::min(timing.release_lead * std::min(timing.speed, stoppable), 0.5 * wished_room);
  const double end_room = wished_room - late;
  const double room = timing.length - ramped - end_room;
  if (room < 0.0) {
    return false;
  }
  const double end_speed = std::sqrt(2.0 * timing.end_acceleration * end_room);
  const Crossing way = cross(enter, timing.speed, timing.acceleration, end_speed, room);

  length_ = timing.length;
  start_speed_ = timing.start_speed;
  acceleration_ = std::max(timing.acceleration, std::abs(way.first));
  phases_ = {};
  phases_[0] = {timing.ramp_time, ramp};
  phases_[1] = {std::abs(way.cruise - enter) / std::abs(way.first), way.first};
  phases_[3] = {(way.cruise - way.leave) / way.last, -way.last};
  const double changing =
      0.5 * (enter + way.cruise) * phases_[1].duration + 0.5 * (way.cruise + way.leave) * phases_[3].duration;
  phases_[2].duration = way.cruise > small ? std::max(0.0, room - changing) / way.cruise : 0.0;
  if (end_room > 0.0 && way.leave > small) {
    phases_[4] = {2.0 * end_room / way.leave, -0.5 * way.leave * way.leave / end_room};
  }
  duration_ = 0.0;
  for (const Phase & phase : phases_) {
    duration_ += phase.duration;
  }
  release_time_ = duration_ - phases_[4].duration;
  if (end_room > 0.0 && way.leave > small) {
    release_time_ = std::max(0.0, release_time_ - late / way.leave);
  }
  return way.possible || timing.ramp_time <= 0.0;
}

double SpeedProfile::middle_to_middle(const PathTiming & timing) const
{
  return duration_ - 0.5 * (timing.ramp_time + phases_[4].duration);
}

SpeedProfile SpeedProfile::in_time(PathTiming timing, double time, double speed_limit,
                                   double acceleration_limit)
{
  // A triangle needs 4 s / t^2 at least.
  const double least = 4.0 * timing.length / (time * time);
  timing.acceleration = std::min(std::max(timing.acceleration, least), acceleration_limit);
  timing.end_acceleration = timing.acceleration;
  timing.speed = speed_limit;
  SpeedProfile fitting(timing);
  if (fitting.middle_to_middle(timing) >= time) {
    return fitting;
  }
  double slow = 0.0, fast = speed_limit;
  for (int i = 0; i < 80; ++i) {
    timing.speed = 0.5 * (slow + fast);
    const SpeedProfile tried(timing);
    const bool in_time = tried.middle_to_middle(timing) <= time;
    (in_time ? fast : slow) = timing.speed;
    fitting = in_time ? tried : fitting;
  }
  return fitting;
}

SpeedProfile::Sample SpeedProfile::at(double time) const
{
  if (time >= duration_) {
    return {length_, 0.0};
  }
  Sample now{0.0, start_speed_};
  double left = std::max(0.0, time);
  for (const Phase & phase : phases_) {
    const double passed = std::min(left, phase.duration);
    now.distance += passed * (now.speed + 0.5 * phase.acceleration * passed);
    now.speed += phase.acceleration * passed;
    left -= passed;
  }
  return {std::min(now.distance, length_), std::max(0.0, now.speed)};
}

}  // namespace ur_simulator
