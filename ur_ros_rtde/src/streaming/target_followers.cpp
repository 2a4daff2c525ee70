#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double periods_ahead = 1.5;
// Smaller values command no motion.
constexpr double standstill_speed = 1e-3;       // m/s, rad/s, of a twist
constexpr double standstill_step = 1e-4;        // m, rad, from one target to the next
constexpr double standstill_distance = 1e-2;    // m, rad, of a target from the arm
constexpr double max_cycles_of_a_pose = 2.0;    // by which it advances after a gap: servoL does not bridge it
constexpr double highest_linear_speed = 3.0;    // m/s
constexpr double highest_angular_speed = 3.14;  // rad/s

std::vector<double> to_ur(const Vector6 & values)
{
  return {values.begin(), values.end()};
}

double largest(const Vector6 & values)
{
  double result = 0.0;
  for (const double value : values) {
    result = std::max(result, std::abs(value));
  }
  return result;
}

/// Largest distance of a joint, rad.
double joint_distance(const Vector6 & a, const Vector6 & b)
{
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result = std::max(result, std::abs(a[i] - b[i]));
  }
  return result;
}

/// Largest component of the pose `b` in `a`, m or rad.
double component_distance(const Vector6 & a, const Vector6 & b)
{
  return largest(pose_trans(pose_inverse(a), b));
}

/// Progress along a straight line.
class LineProgress {
 public:
  /// `duration`: s.
  void begin(double duration)
  {
    duration_ = duration;
    passed_ = 0.0;
  }
  double advance(double elapsed)
  {
    passed_ = std::min(passed_ + elapsed, duration_);
    return duration_ > 0.0 ? passed_ / duration_ : 1.0;
  }

 private:
  double duration_ = 0.0;
  double passed_ = 0.0;
};

/// Duration of the line to a new target. The period of the messages determines the speed, except on the way
/// to the first targets: until the arm has reached them, the default speeds apply.
class LineDuration {
 public:
  void begin() { caught_up_ = false; }
  /// s. `period`: between messages, s. The other arguments: durations at the default and at the highest
  /// speed, s.
  double seconds(double period, double at_default_speed, double at_highest_speed)
  {
    const double given = periods_ahead * period;
    caught_up_ = caught_up_ || at_default_speed <= given;
    return std::max({given, at_highest_speed, caught_up_ ? 0.0 : at_default_speed});
  }

 private:
  bool caught_up_ = false;
};

class JointFollower : public TargetFollower {
 public:
  explicit JointFollower(const StreamOptions & options) : options_(options) {}

  bool moves(const StreamTarget & target, const StreamTarget * before, const Sample & sample) const override
  {
    return before == nullptr || joint_distance(before->values, target.values) > standstill_step ||
           joint_distance(sample.actual_q, target.values) > standstill_distance;
  }

  void begin(const Sample & sample, double cycle, const ArmLimits & limits) override
  {
    cycle_ = cycle;
    clock_.emplace(cycle);
    limits_ = limits;
    from_ = to_ = at_ = sample.actual_q;
    line_.begin(0.0);
    duration_.begin();
  }

  Status set_target(const StreamTarget & target, double period) override
  {
    double at_default_speed = 0.0;
    double at_highest_speed = 0.0;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const double jump = std::abs(target.values[i] - at_[i]);
      if (!(jump <= options_.max_joint_jump)) {
        return failure(
            ErrorCode::invalid_goal,
            fmt::format(
                "the target of {} is {:.3f} rad from the last command, at most {:.3f} rad are allowed: "
                "start at the current position and move more slowly",
                joint_names()[i], jump, options_.max_joint_jump));
      }
      at_default_speed = std::max(at_default_speed, jump / default_joint_speed);
      at_highest_speed = std::max(at_highest_speed, jump / limits_.velocity[i]);
    }
    from_ = at_;
    to_ = target.values;
    line_.begin(duration_.seconds(period, at_default_speed, at_highest_speed));
    return {};
  }

  Status advance(Run & run, const Sample & sample, double elapsed) override
  {
    const double share = line_.advance(clock_->advance(sample, elapsed));
    for (std::size_t i = 0; i < at_.size(); ++i) {
      at_[i] = from_[i] + share * (to_[i] - from_[i]);
    }
    run.control()->servoJ(to_ur(at_), 0.0, 0.0, cycle_, options_.lookahead_time, options_.gain,
                          clock_->time());
    return {};
  }

 private:
  const StreamOptions options_;
  ArmLimits limits_{};
  double cycle_ = 0.0;
  std::optional<SetpointClock> clock_;  // from begin()
  Vector6 from_{}, to_{}, at_{};
  LineProgress line_;
  LineDuration duration_;
};

/// The orientation is the identity.
bool position_only(const StreamTarget & target)
{
  return target.values[3] == 0.0 && target.values[4] == 0.0 && target.values[5] == 0.0;
}

class PoseFollower : public TargetFollower {
 public:
  explicit PoseFollower(const StreamOptions & options) : options_(options) {}

  bool moves(const StreamTarget & target, const StreamTarget * before, const Sample & sample) const override
  {
    return before == nullptr || component_distance(before->values, target.values) > standstill_step ||
           component_distance(sample.actual_tcp_pose, target.values) > standstill_distance;
  }

  void begin(const Sample & sample, double cycle, const ArmLimits & limits) override
  {
    cycle_ = cycle;
    limits_ = limits;
    from_ = at_ = sample.actual_tcp_pose;
    displacement_ = {};
    line_.begin(0.0);
    duration_.begin();
  }

  Status set_target(const StreamTarget & target, double period) override
  {
    const Vector6 displacement = pose_trans(pose_inverse(at_), target.values);
    const double distance = length(position(displacement));
    const double angle = length(rotation(displacement));
    if (!(distance <= options_.max_linear_jump && angle <= options_.max_joint_jump)) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("the target is {:.3f} m and {:.3f} rad from the last command, at most "
                      "{:.3f} m and {:.3f} rad are allowed: start at the current pose and move more slowly{}",
                      distance, angle, options_.max_linear_jump, options_.max_joint_jump,
                      position_only(target) && angle > options_.max_joint_jump
                          ? "; its orientation is (0, 0, 0, 1), as in a pose of which only the position was "
                            "set: set the orientation in each message"
                          : ""));
    }
    from_ = at_;
    displacement_ = displacement;
    line_.begin(duration_.seconds(period,
                                  std::max(distance / default_linear_speed, angle / default_angular_speed),
                                  std::max(distance / highest_linear_speed, angle / highest_angular_speed)));
    return {};
  }

  Status advance(Run & run, const Sample & sample, double elapsed) override
  {
    if (Status safe = check_joint_velocities(sample, limits_); !safe) {
      return safe;
    }
    Vector6 part = displacement_;
    const double share = line_.advance(std::min(elapsed, max_cycles_of_a_pose * cycle_));
    for (double & value : part) {
      value *= share;
    }
    at_ = pose_trans(from_, part);
    run.control()->servoL(to_ur(at_), 0.0, 0.0, cycle_, options_.lookahead_time, options_.gain);
    return {};
  }

 private:
  const StreamOptions options_;
  ArmLimits limits_{};
  double cycle_ = 0.0;
  Vector6 from_{}, at_{};
  Vector6 displacement_{};  ///< in the frame of from_
  LineProgress line_;
  LineDuration duration_;
};

class TwistFollower : public TargetFollower {
 public:
  explicit TwistFollower(const StreamOptions & options) : options_(options) {}

  bool moves(const StreamTarget & target, const StreamTarget *, const Sample &) const override
  {
    return largest(target.values) > standstill_speed;
  }

  void begin(const Sample &, double cycle, const ArmLimits & limits) override
  {
    cycle_ = cycle;
    limits_ = limits;
    target_ = {};
  }

  Status set_target(const StreamTarget & target, double) override
  {
    const double linear = length(position(target.values));
    const double angular = length(rotation(target.values));
    if (!(linear <= highest_linear_speed && angular <= highest_angular_speed)) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("the target velocity is {:.3g} m/s and {:.3g} rad/s, at most {} m/s and {} rad/s "
                      "are possible: use a lower one",
                      linear, angular, highest_linear_speed, highest_angular_speed));
    }
    target_ = target;
    return {};
  }

  Status advance(Run & run, const Sample & sample, double) override
  {
    if (Status safe = check_joint_velocities(sample, limits_); !safe) {
      return safe;
    }
    Vector6 twist = target_.values;
    if (target_.in_tool_frame) {
      const Vector3 orientation = rotation(sample.actual_tcp_pose);
      const Vector3 linear = rotate(orientation, {twist[0], twist[1], twist[2]});
      const Vector3 angular = rotate(orientation, {twist[3], twist[4], twist[5]});
      twist = {linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]};
    }
    // Without a time, speedl returns when the arm has reached the speed (UR, Script Manual): the control
    // program would take the next twist, which may be zero, only then.
    run.control()->speedL(to_ur(twist), options_.acceleration, cycle_);
    return {};
  }

 private:
  const StreamOptions options_;
  double cycle_ = 0.0;
  ArmLimits limits_{};
  StreamTarget target_{};
};
}  // namespace

Status check_joint_velocities(const Sample & sample, const ArmLimits & limits)
{
  for (std::size_t i = 0; i < limits.velocity.size(); ++i) {
    if (!(std::abs(sample.target_qd[i]) <= limits.velocity[i])) {
      return failure(ErrorCode::safety_violation,
                     fmt::format("{} would move at {:.2f} rad/s, its limit is {:.2f} rad/s: the arm is close "
                                 "to a singularity, or the target is too fast",
                                 joint_names()[i], std::abs(sample.target_qd[i]), limits.velocity[i]));
    }
  }
  return {};
}

std::unique_ptr<TargetFollower> follow_joints(const StreamOptions & options)
{
  return std::make_unique<JointFollower>(options);
}

std::unique_ptr<TargetFollower> follow_poses(const StreamOptions & options)
{
  return std::make_unique<PoseFollower>(options);
}

std::unique_ptr<TargetFollower> follow_twists(const StreamOptions & options)
{
  return std::make_unique<TwistFollower>(options);
}

}  // namespace ur_ros_rtde
