#include "motion/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double rounding = 1e-9;  // relative to the limit

Point point_at(const Motion & motion, const TimingLawPiece & piece, double time)
{
  const PathPiece & curve = motion.path->pieces[piece.piece];
  const PathState path_state = piece.at(time);
  return joint_motion(curve.at(std::clamp(path_state.u, 0.0, curve.length)), path_state);
}

// Maximum of equally spaced values, including the vertex of the parabola through every three of them.
template <int rows>
class Peak {
 public:
  using Rows = Eigen::Array<double, rows, 1>;

  void add(const Rows & value)
  {
    largest_ = largest_.max(value);
    if (++count_ >= 3) {
      const Rows curvature = (2.0 * before_ - first_ - value).max(1e-12);
      const Rows slope = value - first_;
      largest_ = (slope.abs() < 2.0 * curvature)
                     .select(largest_.max(before_ + slope * slope / (8.0 * curvature)), largest_);
    }
    first_ = before_;
    before_ = value;
  }

  const Rows & largest() const { return largest_; }

 private:
  int count_ = 0;
  Rows largest_ = Rows::Zero();
  Rows first_ = Rows::Zero();
  Rows before_ = Rows::Zero();
};

// Largest ratio of the speed to the maximum speed of the path. The speed is a polynomial in time, so few
// samples are sufficient.
double max_speed_ratio(const Motion & motion, const TimingLawPiece & piece, int inner)
{
  const double top = motion.path->pieces[piece.piece].max_speed;
  double largest = 0.0;
  for (int k = 0; std::isfinite(top) && k <= inner + 1; ++k) {
    largest = std::max(largest, piece.at(piece.start + piece.duration * k / (inner + 1)).v / top);
  }
  return largest;
}

// A piece that covers a large part of a blend needs more points, because the derivatives of the path change.
int steps_of(const Motion & motion, const TimingLawPiece & piece, double step)
{
  constexpr int degree_of_timed_pieces = 5;  // whose parameter is the time
  constexpr double points_per_blend = 200.0;
  constexpr double max_points = 2000.0;  // of a polynomial, which has few extremes
  const PathPiece & curve = motion.path->pieces[piece.piece];
  // Between 20 points, the acceleration of a quintic from rest to rest is 0.3 % above that at the nearest
  // one, of any quintic 1.5 %.
  const double least_points = curve.degree == degree_of_timed_pieces ? 20.0 : 6.0;
  double steps = std::clamp(piece.duration / step, least_points, max_points);
  if (curve.degree > degree_of_timed_pieces) {
    const double covered = (piece.at(piece.end()).u - piece.at(piece.start).u) / curve.length;
    steps = std::max(steps, points_per_blend * std::min(covered, 1.0));
  }
  return static_cast<int>(std::ceil(steps));
}

std::optional<LimitViolation> limit_violation(Quantity quantity, const Joints & value, const Joints & limit,
                                              double time)
{
  int joint = 0;
  if ((value.abs() / limit).maxCoeff(&joint) <= 1.0 + rounding) {
    return std::nullopt;
  }
  return LimitViolation{quantity, joint, time, value[joint], limit[joint]};
}

std::optional<LimitViolation> position_violation(const Joints & q, const Limits & limits, double time)
{
  for (int j = 0; j < joint_count; ++j) {
    if (q[j] < limits.position_min[j] - rounding || q[j] > limits.position_max[j] + rounding) {
      return LimitViolation{Quantity::position, j, time, q[j],
                            q[j] < limits.position_min[j] ? limits.position_min[j] : limits.position_max[j]};
    }
  }
  return std::nullopt;
}

std::optional<LimitViolation> violation_at(const Point & point, const Limits & limits, double time)
{
  // NaN passes every comparison with a limit, so it is checked explicitly.
  if (!(point.position + point.velocity + point.acceleration + point.jerk).isFinite().all()) {
    return LimitViolation{Quantity::position, 0, time, std::numeric_limits<double>::quiet_NaN(),
                          limits.position_max[0]};
  }
  auto excess = position_violation(point.position, limits, time);
  if (!excess) {
    excess = limit_violation(Quantity::velocity, point.velocity, limits.velocity, time);
  }
  if (!excess) {
    excess = limit_violation(Quantity::acceleration, point.acceleration, limits.acceleration, time);
  }
  if (!excess) {
    excess = limit_violation(Quantity::jerk, point.jerk, limits.jerk, time);
  }
  return excess;
}

// On a line, the values of all joints are proportional to speed, acceleration and jerk along it.
PieceUtilization line_utilization(const Motion & motion, const TimingLawPiece & piece, const Limits & limits,
                                  int inner)
{
  Peak<3> peak;
  for (int k = 0; k <= inner + 1; ++k) {
    const PathState state = piece.at(piece.start + piece.duration * k / (inner + 1));
    peak.add({std::abs(state.v), std::abs(state.a), std::abs(state.j)});
  }
  const PathPiece & line = motion.path->pieces[piece.piece];
  const Joints direction = line.c[1].abs() / line.length;
  return {direction * peak.largest()[0] / limits.velocity,
          direction * peak.largest()[1] / limits.acceleration, direction * peak.largest()[2] / limits.jerk,
          max_speed_ratio(motion, piece, inner)};
}

}  // namespace

PieceUtilization piece_utilization(const Motion & motion, const TimingLawPiece & piece, const Limits & limits,
                                   int inner)
{
  const PathPiece & curve = motion.path->pieces[piece.piece];
  if (curve.is_line() && curve.length > 0.0) {
    return line_utilization(motion, piece, limits, inner);
  }
  Peak<joint_count> velocity;
  Peak<joint_count> acceleration;
  Peak<joint_count> jerk;
  for (int k = 0; k <= inner + 1; ++k) {
    const Point point = point_at(motion, piece, piece.start + piece.duration * k / (inner + 1));
    velocity.add(point.velocity.abs());
    acceleration.add(point.acceleration.abs());
    jerk.add(point.jerk.abs());
  }
  return {velocity.largest() / limits.velocity, acceleration.largest() / limits.acceleration,
          jerk.largest() / limits.jerk, max_speed_ratio(motion, piece, inner)};
}

Utilization max_utilization(const Motion & motion, std::size_t begin, const Limits & limits)
{
  Utilization largest;
  for (std::size_t k = begin; k < motion.timing.size(); ++k) {
    const PieceUtilization use = piece_utilization(motion, motion.timing[k], limits,
                                                   steps_of(motion, motion.timing[k], verification_step) - 1);
    largest.velocity = std::max({largest.velocity, use.velocity.maxCoeff(), use.speed});
    largest.acceleration = std::max(largest.acceleration, use.acceleration.maxCoeff());
    largest.jerk = std::max(largest.jerk, use.jerk.maxCoeff());
  }
  return largest;
}

std::optional<LimitViolation> first_violation(const Motion & motion, const TimingLawPiece & piece,
                                              const Limits & limits, double step, Utilization & use)
{
  const int steps = steps_of(motion, piece, step);
  for (int k = 0; k <= steps; ++k) {
    const double time = piece.start + piece.duration * k / steps;
    const Point point = point_at(motion, piece, time);
    use.velocity = std::max(use.velocity, (point.velocity.abs() / limits.velocity).maxCoeff());
    use.acceleration =
        std::max(use.acceleration, (point.acceleration.abs() / limits.acceleration).maxCoeff());
    use.jerk = std::max(use.jerk, (point.jerk.abs() / limits.jerk).maxCoeff());
    if (auto excess = violation_at(point, limits, time)) {
      return excess;
    }
    const double share = piece.at(time).v / motion.path->pieces[piece.piece].max_speed;
    if (share > 1.0 + rounding) {
      return LimitViolation{Quantity::path_speed, 0, time, share, 1.0};
    }
  }
  return std::nullopt;
}

std::optional<LimitViolation> first_violation(const Motion & motion, const Limits & limits, double step,
                                              Utilization & use)
{
  for (const TimingLawPiece & piece : motion.timing) {
    if (auto excess = first_violation(motion, piece, limits, step, use)) {
      return excess;
    }
  }
  return std::nullopt;
}

Status check_duration(const Motion & motion)
{
  if (motion.duration() <= max_duration) {
    return {};
  }
  return failure(
      ErrorCode::invalid_goal,
      fmt::format("the motion would take {:.6g} s, at most {:.0f} s are possible: make it faster, or "
                  "send it in parts",
                  motion.duration(), max_duration));
}

std::string describe(const LimitViolation & excess, std::size_t waypoint)
{
  if (excess.quantity == Quantity::path_speed) {
    return fmt::format("speed along the path is {:.6g} times its limit at {:.4f} s (after waypoint {})",
                       excess.value, excess.time, waypoint);
  }
  static constexpr std::array names{"position", "velocity", "acceleration", "jerk"};
  static constexpr std::array units{"rad", "rad/s", "rad/s^2", "rad/s^3"};
  const auto index = static_cast<std::size_t>(excess.quantity);
  return fmt::format("{} of {} is {:.6g} {} at {:.4f} s (after waypoint {}), its limit {:.6g} {}",
                     names[index], joint_name(excess.joint), excess.value, units[index], excess.time,
                     waypoint, excess.limit, units[index]);
}

Expected<Utilization> Trajectory::verify(const Limits & limits, double step) const
{
  Utilization use;
  if (const auto excess = first_violation(*motion_, limits, step, use)) {
    return failure(ErrorCode::invalid_goal, describe(*excess, waypoint_at(excess->time)));
  }
  return use;
}

}  // namespace ur_ros_rtde::trajectory
