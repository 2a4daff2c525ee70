#include "motion/servo/servo.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_linear_speed = 3.0;    // m/s
constexpr double max_angular_speed = 3.14;  // rad/s
constexpr double max_rate_change = 2.0;     // 1/s, the ramp of the controller's speed slider
}  // namespace

Outcome servo(Run & run, const ServoMotion & motion, const std::function<void(const ServoStep &)> & send,
              const std::function<Outcome()> & wait_for_arrival)
{
  if (Outcome begins = run.check_again(motion.check); !begins) {
    return begins;
  }
  const ArmLimits limits = run.robot().limits();
  const double cycle = run.robot().cycle_time();
  Sample sample = run.state();
  SetpointClock clock(cycle);
  double rate = sample.requested_rate();
  bool at_end = false;
  for (double time = 0.0; !at_end;) {
    at_end = clock.is_at_end(time - motion.duration);
    const double before = sample.controller_time;
    if (auto stop_reason = run.next(sample)) {
      return *stop_reason;
    }
    if (motion.has_poses) {
      if (Status safe = check_joint_velocities(sample, limits); !safe) {
        return safe;
      }
    }
    const double elapsed =
        clock.advance(sample, std::clamp(sample.controller_time - before, 0.0, 2.0 * cycle));
    const double change = sample.requested_rate() - rate;
    rate += std::clamp(change, -max_rate_change * elapsed, max_rate_change * elapsed);
    time += rate * elapsed;
    run.progress(smooth_step(std::min(time / motion.duration, 1.0)));
    send({run.progress(), cycle, clock.time()});
  }
  return finish_servo(run, wait_for_arrival(), motion.deceleration);
}

Outcome finish_servo(Run & run, const Outcome & arrival, double deceleration)
{
  if (arrival) {
    run.control()->servoStop(deceleration);
  }
  return arrival;
}

void check_tcp_speed(Check & check, const Vector6 & from, const std::vector<double> & to, double time)
{
  const PoseDistance distance = pose_distance(from, to);
  const double linear = smooth_step_peak * distance.linear;
  const double angular = smooth_step_peak * distance.angular;
  const double min_time = std::max(linear / max_linear_speed, angular / max_angular_speed);
  check.that(
      time >= min_time,
      fmt::format("the TCP would need {:.3f} m/s and {:.3f} rad/s to reach pose in {:.3f} s, the limits "
                  "are {} m/s and {} rad/s: use a time of at least {:.3f} s",
                  linear / time, angular / time, time, max_linear_speed, max_angular_speed, min_time));
}

}  // namespace ur_ros_rtde
