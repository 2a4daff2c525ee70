#include "kinematics/inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/pose.hpp"
#include "kinematics/forward.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
constexpr double rounding = 1e-10;       // what a cosine may exceed 1 by and still count as reachable
constexpr double wrist_singular = 1e-8;  // |sin q5| under which joint 6 is free

double wrap(double angle)
{
  const double wrapped = std::remainder(angle, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

/// Clamps to [-1, 1] what only rounding pushed out of it.
std::optional<double> sine_or_cosine(double value)
{
  if (!(std::abs(value) <= 1.0 + rounding)) {
    return std::nullopt;
  }
  return std::clamp(value, -1.0, 1.0);
}

/// One side of the shoulder, one way up of the wrist: what is known of the posture before the elbow is
/// chosen.
struct Wrist {
  double q1, q5, q6;
};

/// The planar part: joints 2, 3, 4 from the frame 4 that joints 1, 5, 6 leave, seen from frame 1.
void solve_elbow(const RobotModel & model, const Transform & flange, const Wrist & wrist,
                 InverseSolutions & out)
{
  const double c1 = std::cos(wrist.q1), s1 = std::sin(wrist.q1);
  const double c5 = std::cos(wrist.q5), s5 = std::sin(wrist.q5);
  const double c6 = std::cos(wrist.q6), s6 = std::sin(wrist.q6);
  const auto & rotation = flange.linear();
  // Axes of frame 5 (before joint 6), then x4 = c5 x5 - s5 z5, and y5 = -z4: joint 5's axis.
  const Vector3 x5 = c6 * rotation.col(0) - s6 * rotation.col(1);
  const Vector3 y5 = s6 * rotation.col(0) + c6 * rotation.col(1);
  const Vector3 z5 = rotation.col(2);
  const Vector3 x4 = c5 * x5 - s5 * z5;
  const Vector3 origin4 = flange.translation() - model.d[5] * z5 + model.d[4] * y5;
  const Vector3 radial(c1, s1, 0.0);  // x axis of frame 1; its y axis is the base's z
  const double px = radial.dot(origin4);
  const double py = origin4.z() - model.d[0];
  const double a2 = model.a[1], a3 = model.a[2];
  const auto c3 = sine_or_cosine((px * px + py * py - a2 * a2 - a3 * a3) / (2.0 * a2 * a3));
  if (!c3) {
    return;
  }
  const double sum234 = std::atan2(x4.z(), radial.dot(x4));
  const double elbow = std::acos(*c3);
  for (const double q3 : {elbow, -elbow}) {
    const double q2 = std::atan2(py, px) - std::atan2(a3 * std::sin(q3), a2 + a3 * std::cos(q3));
    Vector6 & q = out.joints[out.count++];
    q << wrap(wrist.q1), wrap(q2), wrap(q3), wrap(sum234 - q2 - q3), wrap(wrist.q5), wrap(wrist.q6);
    if (elbow < 1e-12) {
      break;  // both ways are the same one
    }
  }
}

/// Both ways up of the wrist for one side of the shoulder.
void solve_wrist(const RobotModel & model, const Transform & flange, double q1, double free_q6,
                 InverseSolutions & out)
{
  const Vector3 z1(std::sin(q1), -std::cos(q1), 0.0);     // direction of axes 2, 3, 4
  const Vector3 seen = flange.linear().transpose() * z1;  // = (s5 c6, -s5 s6, c5)
  const double sine = std::hypot(seen.x(), seen.y());
  if (sine < wrist_singular) {
    solve_elbow(model, flange, {q1, seen.z() > 0.0 ? 0.0 : pi, free_q6}, out);
    return;
  }
  const double q5 = std::atan2(sine, seen.z());
  solve_elbow(model, flange, {q1, q5, std::atan2(-seen.y(), seen.x())}, out);
  solve_elbow(model, flange, {q1, -q5, std::atan2(seen.y(), -seen.x())}, out);
}

/// The whole turns of `angle` that lie within limits: the one nearest to `seed`.
std::optional<double> nearest_turn(double angle, double seed, double lower, double upper)
{
  double turned = angle + 2.0 * pi * std::round((seed - angle) / (2.0 * pi));
  if (turned > upper) {
    turned -= 2.0 * pi * std::ceil((turned - upper) / (2.0 * pi));
  } else if (turned < lower) {
    turned += 2.0 * pi * std::ceil((lower - turned) / (2.0 * pi));
  }
  if (turned < lower || turned > upper) {
    return std::nullopt;
  }
  return turned;
}

std::optional<Vector6> within_limits(const RobotModel & model, const Vector6 & joints, const Vector6 & seed)
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto turned = nearest_turn(joints[i], seed[i], model.position_min[i], model.position_max[i]);
    if (!turned) {
      return std::nullopt;
    }
    result[i] = *turned;
  }
  return result;
}

/// The flange drawn towards the shoulder until it can be reached, by at most `tolerance`.
tl::expected<Vector6, InverseError> nearest_reachable(const RobotModel & model, const Transform & flange,
                                                      const Vector6 & seed, double tolerance)
{
  const Vector3 inwards = (Vector3(0.0, 0.0, model.d[0]) - flange.translation()).normalized();
  const auto drawn_by = [&](double distance) {
    Transform drawn = flange;
    drawn.translation() += distance * inwards;
    return inverse_nearest(model, drawn, seed);
  };
  auto best = drawn_by(tolerance);
  double out = 0.0, in = tolerance;
  for (int i = 0; best && i < 30; ++i) {
    const double middle = 0.5 * (out + in);
    auto attempt = drawn_by(middle);
    if (attempt) {
      best = attempt;
      in = middle;
    } else {
      out = middle;
    }
  }
  return best;
}

}  // namespace

InverseSolutions inverse_all(const RobotModel & model, const Transform & flange, const Vector6 & seed)
{
  InverseSolutions solutions;
  // Joint 5's origin lies d4 beside the plane of the arm, which turns about the base's z axis.
  const Vector3 wrist = flange.translation() - model.d[5] * flange.linear().col(2);
  const double distance = std::hypot(wrist.x(), wrist.y());
  const auto sine = sine_or_cosine(model.d[3] / distance);
  if (!sine) {
    return solutions;
  }
  const double direction = std::atan2(wrist.y(), wrist.x());
  const double aside = std::asin(*sine);
  solve_wrist(model, flange, direction + aside, seed[5], solutions);
  if (pi / 2.0 - aside > 1e-12) {
    solve_wrist(model, flange, direction + pi - aside, seed[5], solutions);
  }
  return solutions;
}

tl::expected<Vector6, InverseError> inverse_nearest(const RobotModel & model, const Transform & flange,
                                                    const Vector6 & seed)
{
  const InverseSolutions solutions = inverse_all(model, flange, seed);
  std::optional<Vector6> best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const Vector6 & joints : solutions) {
    const auto candidate = within_limits(model, joints, seed);
    const double distance = candidate ? (*candidate - seed).squaredNorm() : best_distance;
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (best) {
    return *best;
  }
  return tl::unexpected(solutions.count == 0 ? InverseError::unreachable : InverseError::beyond_limits);
}

tl::expected<Vector6, std::string> get_inverse_kin(const RobotModel & model, const Vector6 & tcp_pose,
                                                   const Vector6 & qnear, const Vector6 & tcp_offset,
                                                   double position_tolerance)
{
  if (!is_finite(tcp_pose) || !is_finite(qnear) || !is_finite(tcp_offset) ||
      !std::isfinite(position_tolerance)) {
    return tl::unexpected(std::string("get_inverse_kin: pose, qnear and tolerances must be finite numbers"));
  }
  const Transform flange = to_transform(tcp_pose) * to_transform(tcp_offset).inverse();
  auto solution = inverse_nearest(model, flange, qnear);
  if (!solution && solution.error() == InverseError::unreachable && position_tolerance > rounding) {
    solution = nearest_reachable(model, flange, qnear, position_tolerance);
  }
  if (solution) {
    return *solution;
  }
  const char * why =
      solution.error() == InverseError::unreachable ? "is out of reach" : "needs a joint beyond its limits";
  return tl::unexpected(
      fmt::format("get_inverse_kin: no solution, the pose p[{:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}] "
                  "{} (reach of a {}: {:.2f} m)",
                  tcp_pose[0], tcp_pose[1], tcp_pose[2], tcp_pose[3], tcp_pose[4], tcp_pose[5], why,
                  model.display_name, model.reach));
}

double dexterity(const RobotModel & model, const Vector6 & joints)
{
  const auto frames = link_frames(model, joints);
  const Vector3 wrist = frames[4].translation();
  // The wrist's distance from the base's axis is never under d4, where both sides of the shoulder meet.
  const double beside = std::hypot(wrist.x(), wrist.y());
  const double shoulder = std::sqrt(std::max(0.0, beside * beside - model.d[3] * model.d[3])) /
                          (std::abs(model.a[1]) + std::abs(model.a[2]));
  return std::min({std::abs(std::sin(joints[4])), std::abs(std::sin(joints[2])), shoulder});
}

}  // namespace ur_simulator
