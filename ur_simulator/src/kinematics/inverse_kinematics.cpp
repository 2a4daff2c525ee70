#include "kinematics/inverse_kinematics.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
constexpr double rounding = 1e-10;  // a cosine may exceed 1 by this much and still count as reachable
constexpr double wrist_singularity_threshold = 1e-8;  // |sin q5| below which joint 6 is free

double wrap(double angle)
{
  const double wrapped = std::remainder(angle, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

/// Clamps to [-1, 1] a sine or cosine that rounding has pushed out of it; nothing if it is further out.
std::optional<double> clamp_to_unit(double value)
{
  if (!(std::abs(value) <= 1.0 + rounding)) {
    return std::nullopt;
  }
  return std::clamp(value, -1.0, 1.0);
}

/// Joints 1, 5 and 6 of one solution of shoulder and wrist.
struct Wrist {
  double q1, q5, q6;
};

/// Solves joints 2, 3 and 4 in the plane of the arm, from frame 4 relative to frame 1. Joints 1, 5 and 6 are
/// known.
void solve_elbow(const RobotModel & model, const Transform & flange, const Wrist & wrist,
                 InverseSolutions & out)
{
  const double c1 = std::cos(wrist.q1), s1 = std::sin(wrist.q1);
  const double c5 = std::cos(wrist.q5), s5 = std::sin(wrist.q5);
  const double c6 = std::cos(wrist.q6), s6 = std::sin(wrist.q6);
  const auto & rotation = flange.linear();
  // Axes of frame 5, then x4 = c5 x5 - s5 z5. y5 = -z4 is the axis of joint 5.
  const Vector3 x5 = c6 * rotation.col(0) - s6 * rotation.col(1);
  const Vector3 y5 = s6 * rotation.col(0) + c6 * rotation.col(1);
  const Vector3 z5 = rotation.col(2);
  const Vector3 x4 = c5 * x5 - s5 * z5;
  const Vector3 origin4 = flange.translation() - model.d[5] * z5 + model.d[4] * y5;
  const Vector3 radial(c1, s1, 0.0);  // x axis of frame 1; its y axis is the base's z
  const double px = radial.dot(origin4);
  const double py = origin4.z() - model.d[0];
  const double a2 = model.a[1], a3 = model.a[2];
  const auto c3 = clamp_to_unit((px * px + py * py - a2 * a2 - a3 * a3) / (2.0 * a2 * a3));
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
      break;  // elbow up and elbow down coincide
    }
  }
}

/// Solves both wrist configurations for one shoulder configuration.
void solve_wrist(const RobotModel & model, const Transform & flange, double q1, double free_q6,
                 InverseSolutions & out)
{
  const Vector3 z1(std::sin(q1), -std::cos(q1), 0.0);             // direction of axes 2, 3, 4
  const Vector3 z1_in_flange = flange.linear().transpose() * z1;  // = (s5 c6, -s5 s6, c5)
  const double sine = z1_in_flange.head<2>().norm();
  if (sine < wrist_singularity_threshold) {
    solve_elbow(model, flange, {q1, z1_in_flange.z() > 0.0 ? 0.0 : pi, free_q6}, out);
    return;
  }
  const double q5 = std::atan2(sine, z1_in_flange.z());
  solve_elbow(model, flange, {q1, q5, std::atan2(-z1_in_flange.y(), z1_in_flange.x())}, out);
  solve_elbow(model, flange, {q1, -q5, std::atan2(z1_in_flange.y(), -z1_in_flange.x())}, out);
}

/// The angle within the limits that is nearest to `seed` and equals `angle` up to multiples of 2 pi.
std::optional<double> nearest_equivalent_angle(double angle, double seed, double lower, double upper)
{
  double candidate = angle + 2.0 * pi * std::round((seed - angle) / (2.0 * pi));
  if (candidate > upper) {
    candidate -= 2.0 * pi * std::ceil((candidate - upper) / (2.0 * pi));
  } else if (candidate < lower) {
    candidate += 2.0 * pi * std::ceil((lower - candidate) / (2.0 * pi));
  }
  if (candidate < lower || candidate > upper) {
    return std::nullopt;
  }
  return candidate;
}

std::optional<Vector6> within_limits(const RobotModel & model, const Vector6 & joints, const Vector6 & seed)
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto candidate =
        nearest_equivalent_angle(joints[i], seed[i], model.position_min[i], model.position_max[i]);
    if (!candidate) {
      return std::nullopt;
    }
    result[i] = *candidate;
  }
  return result;
}

tl::expected<Vector6, InverseError> nearest_closed_form_solution(const RobotModel & model,
                                                                 const Transform & flange,
                                                                 const Vector6 & seed)
{
  const InverseSolutions solutions = all_inverse_solutions(model, flange, seed);
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

/// Displacement of the flange from its pose at `joints` to `flange`: m and rad, in the base frame.
Vector6 flange_displacement(const Transform & from, const Transform & to)
{
  const Eigen::AngleAxisd turned(to.linear() * from.linear().transpose());
  Vector6 result;
  result << to.translation() - from.translation(), turned.angle() * turned.axis();
  return result;
}

/// Newton's method, with damping next to singularities. Nothing if it does not converge, or leads more than
/// `max_change` rad away from `start`.
std::optional<Vector6> newton(const RobotModel & model, const Transform & flange, const Vector6 & start,
                              double max_change)
{
  constexpr int max_iterations = 30;
  constexpr double tolerance = 1e-11;  // m and rad
  Vector6 joints = start;
  for (int i = 0; i < max_iterations; ++i) {
    const auto frames = link_frames(model, joints);
    const Vector6 error = flange_displacement(frames[5], flange);
    if (error.cwiseAbs().maxCoeff() < tolerance) {
      return joints;
    }
    const Matrix6 j = jacobian(frames, frames[5].translation());
    const double damping = 1e-12 + 1e-3 * std::min(1e-3, error.squaredNorm());
    joints += (j.transpose() * j + damping * Matrix6::Identity()).ldlt().solve(j.transpose() * error);
    if (!((joints - start).cwiseAbs().maxCoeff() <= max_change)) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

Transform moved_towards_shoulder(const RobotModel & model, Transform flange, double distance)
{
  const Vector3 shoulder(0.0, 0.0, model.d[0]);
  flange.translation() += distance * (shoulder - flange.translation()).normalized();
  return flange;
}

tl::expected<Vector6, InverseError> nearest_calibrated_solution(const RobotModel & model,
                                                                const Transform & flange,
                                                                const Vector6 & seed)
{
  constexpr double small_change = 0.1;  // rad
  constexpr double any_change = 1.0;    // rad; the calibration changes joints much less
  if (const auto near_seed = newton(model, flange, seed, small_change)) {
    if (const auto joints = within_limits(model, *near_seed, seed)) {
      return *joints;
    }
  }
  bool reachable = false;
  // The method converges slowly from a stretched arm, and a calibrated arm may reach farther: bent a little.
  for (const double inwards : {0.0, 0.01}) {  // m
    std::optional<Vector6> best;
    for (const Vector6 & guess :
         all_inverse_solutions(model, moved_towards_shoulder(model, flange, inwards), seed)) {
      const auto solution = newton(model, flange, guess, any_change);
      reachable = reachable || solution;
      const auto joints = solution ? within_limits(model, *solution, seed) : std::nullopt;
      if (joints && (!best || (*joints - seed).squaredNorm() < (*best - seed).squaredNorm())) {
        best = joints;
      }
    }
    if (best) {
      return *best;
    }
  }
  return tl::unexpected(reachable ? InverseError::beyond_limits : InverseError::unreachable);
}

/// Solves for the flange moved towards the shoulder until it is reachable, by `tolerance` at most.
tl::expected<Vector6, InverseError> nearest_reachable(const RobotModel & model, const Transform & flange,
                                                      const Vector6 & seed, double tolerance)
{
  const auto solve_at = [&](double distance) {
    return nearest_inverse_solution(model, moved_towards_shoulder(model, flange, distance), seed);
  };
  auto best = solve_at(tolerance);
  double out = 0.0, in = tolerance;
  for (int i = 0; best && i < 30; ++i) {
    const double middle = 0.5 * (out + in);
    auto attempt = solve_at(middle);
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

InverseSolutions all_inverse_solutions(const RobotModel & model, const Transform & flange,
                                       const Vector6 & seed)
{
  InverseSolutions solutions;
  // The origin of joint 5 lies at distance d4 from the plane of the arm, which rotates about the z axis of
  // the base.
  const Vector3 wrist = flange.translation() - model.d[5] * flange.linear().col(2);
  const double distance = wrist.head<2>().norm();
  const auto sine = clamp_to_unit(model.d[3] / distance);
  if (!sine) {
    return solutions;
  }
  const double direction = std::atan2(wrist.y(), wrist.x());
  const double shoulder_angle = std::asin(*sine);
  solve_wrist(model, flange, direction + shoulder_angle, seed[5], solutions);
  if (pi / 2.0 - shoulder_angle > 1e-12) {
    solve_wrist(model, flange, direction + pi - shoulder_angle, seed[5], solutions);
  }
  return solutions;
}

tl::expected<Vector6, InverseError> nearest_inverse_solution(const RobotModel & model,
                                                             const Transform & flange, const Vector6 & seed)
{
  if (model.calibrated) {
    return nearest_calibrated_solution(model, flange, seed);
  }
  return nearest_closed_form_solution(model, flange, seed);
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
  auto solution = nearest_inverse_solution(model, flange, qnear);
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

double singularity_distance(const RobotModel & model, const Vector6 & joints)
{
  const auto frames = link_frames(model, joints);
  const Vector3 wrist = frames[4].translation();
  // The distance of the wrist from the base axis is at least d4, where both shoulder configurations coincide.
  const double wrist_distance = wrist.head<2>().norm();
  const double shoulder =
      std::sqrt(std::max(0.0, wrist_distance * wrist_distance - model.d[3] * model.d[3])) /
      (std::abs(model.a[1]) + std::abs(model.a[2]));
  return std::min({std::abs(std::sin(joints[4])), std::abs(std::sin(joints[2])), shoulder});
}

}  // namespace ur_simulator
