#include "ur_ros_rtde_trajectory/timed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/motion.hpp"
#include "path/quintic_hermite.hpp"
#include "path/spline.hpp"
#include "trajectory/check_positions.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double at_rest = 1e-3;            // rad/s; lower velocities count as rest
constexpr double shortest_step = 1e-4;      // s; below, rounding errors dominate
constexpr double longest_sampling = 0.101;  // s; MoveIt samples every 0.1 s

struct Knots {
  std::vector<double> widths;  // s
  std::vector<Joints> q, v, a;
};

Status check_times(const std::vector<double> & times)
{
  if (times.empty()) {
    return failure(ErrorCode::invalid_goal, "times is empty: give at least one waypoint");
  }
  if (times.size() > max_timed_waypoints) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("times has {} entries, at most {} are possible: send the "
                               "trajectory in parts",
                               times.size(), max_timed_waypoints));
  }
  if (!(std::abs(times[0]) < 1e-9)) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("times[0] is {} s: the first must be 0, with the position where the arm is", times[0]));
  }
  if (!(times.back() <= max_duration)) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("times[{}] is {:.6g} s: times begin at 0 and end at {:.0f} s at the latest: send "
                    "the trajectory in parts",
                    times.size() - 1, times.back(), max_duration));
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !(times[i] - times[i - 1] >= shortest_step)) {
      return failure(
          ErrorCode::invalid_goal,
          fmt::format("times[{}] is {} s after times[{}] = {} s: times must increase by at least {} s", i,
                      times[i], i - 1, times[i - 1], shortest_step));
    }
  }
  return {};
}

Expected<std::vector<Joints>> read_list(std::string_view field, const std::vector<std::vector<double>> & list,
                                        std::size_t count)
{
  if (list.size() != count) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("{} has {} entries, times has {}: give one for each time", field, list.size(), count));
  }
  std::vector<Joints> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto values = to_joints(field, list[i]);
    if (!values) {  // the name of the entry takes longer to make than the check
      return tl::unexpected(to_joints(fmt::format("{}[{}]", field, i), list[i]).error());
    }
    result.push_back(*values);
  }
  return result;
}

// Velocities of the cubic spline with rest at both ends. Between waypoints that are far apart in time, they
// are limited so that no joint passes a position at which it is held or turns back. Close ones are samples of
// a smooth motion, which turns back between two of them.
std::vector<Joints> spline_velocities(const Knots & knots)
{
  if (knots.q.size() < 2) {
    return {Joints::Zero()};
  }
  auto velocities = clamped_spline_slopes(knots.q, knots.widths, Joints::Zero(), Joints::Zero());
  limit_slopes(velocities, knots.q, knots.widths, longest_sampling);
  return velocities;
}

// Harmonic mean of the accelerations of the two cubics that meet at each inner knot (for the cubic spline
// they are equal unless its slopes were limited), 0 if their signs differ: the cubic of a short interval must
// not swing the arm in a long one. Between positions at rest, the quintic stays between them. Zero at both
// ends.
std::vector<Joints> estimated_accelerations(const Knots & knots)
{
  std::vector<Joints> result(knots.q.size(), Joints::Zero());
  for (std::size_t i = 1; i + 1 < knots.q.size(); ++i) {
    const double before = knots.widths[i - 1];
    const double after = knots.widths[i];
    const Joints left = (2.0 * knots.v[i - 1] + 4.0 * knots.v[i]) / before -
                        6.0 * (knots.q[i] - knots.q[i - 1]) / (before * before);
    const Joints right = 6.0 * (knots.q[i + 1] - knots.q[i]) / (after * after) -
                         (4.0 * knots.v[i] + 2.0 * knots.v[i + 1]) / after;
    result[i] = (left * right > 0.0).select(2.0 * left * right / (left + right), 0.0);
  }
  return result;
}

Status check_rest(std::vector<Joints> & velocities)
{
  for (const bool last : {false, true}) {
    Joints & velocity = last ? velocities.back() : velocities.front();
    for (int j = 0; j < joint_count; ++j) {
      if (std::abs(velocity[j]) > at_rest) {
        return failure(ErrorCode::invalid_goal,
                       fmt::format("velocities: {} of {} is {} rad/s: a trajectory begins and ends at rest",
                                   last ? "the last" : "the first", joint_name(j), velocity[j]));
      }
    }
    velocity.setZero();
  }
  return {};
}

// The arm is at rest before and after the trajectory, so that an acceleration at an end is a step.
Status check_steps(const std::vector<Joints> & accelerations, const Limits & limits)
{
  constexpr double cycle = 0.002;  // s
  for (const bool last : {false, true}) {
    for (int j = 0; j < joint_count; ++j) {
      const double step = (last ? accelerations.back() : accelerations.front())[j];
      if (!(std::abs(step) <= limits.jerk[j] * cycle)) {
        return failure(
            ErrorCode::invalid_goal,
            fmt::format(
                "accelerations: {} of {} is {:.6g} rad/s^2, a step from rest that needs a jerk of {:.6g} "
                "rad/s^3, its limit is {:.6g} rad/s^3: begin and end with 0, or raise the limit",
                last ? "the last" : "the first", joint_name(j), step, std::abs(step) / cycle,
                limits.jerk[j]));
      }
    }
  }
  return {};
}

// Reads the given lists. Lists that are not given stay empty.
Expected<Knots> read_given(const TimedWaypoints & waypoints, const Limits & limits)
{
  if (auto status = check_times(waypoints.times); !status) {
    return tl::unexpected(status.error());
  }
  if (waypoints.velocities.empty() && !waypoints.accelerations.empty()) {
    return failure(ErrorCode::invalid_goal,
                   "accelerations are given without velocities: give both or neither");
  }
  const std::size_t count = waypoints.times.size();
  Knots knots;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    knots.widths.push_back(waypoints.times[i + 1] - waypoints.times[i]);
  }
  const auto read = [count](std::string_view field, const auto & list, std::vector<Joints> & into) -> Status {
    return read_list(field, list, count).map([&into](std::vector<Joints> values) {
      into = std::move(values);
    });
  };
  Status status = read("positions", waypoints.positions, knots.q);
  if (status && !waypoints.velocities.empty()) {
    status = read("velocities", waypoints.velocities, knots.v);
    if (status) {
      status = check_rest(knots.v);
    }
  }
  if (status && !waypoints.accelerations.empty()) {
    status = read("accelerations", waypoints.accelerations, knots.a);
    if (status) {
      status = check_steps(knots.a, limits);
    }
  }
  return status.map([&knots] { return std::move(knots); });
}

Expected<Knots> read_knots(const TimedWaypoints & waypoints, const Limits & limits)
{
  return read_given(waypoints, limits).map([](Knots knots) {
    if (knots.v.empty()) {
      knots.v = spline_velocities(knots);
    }
    if (knots.a.empty()) {
      knots.a = estimated_accelerations(knots);
    }
    return knots;
  });
}

PathPiece quintic(const Knots & knots, std::size_t i, double start)
{
  PathPiece piece;
  piece.start = start;
  piece.length = knots.widths[i];
  piece.degree = 5;
  const double t = piece.length;
  const Joints rise = knots.q[i + 1] - knots.q[i];
  const Joints v0 = knots.v[i] * t;
  const Joints v1 = knots.v[i + 1] * t;
  const Joints a0 = knots.a[i] * (t * t);
  const Joints a1 = knots.a[i + 1] * (t * t);
  const auto coefficients = quintic_hermite(knots.q[i], rise, v0, v1, a0, a1);
  std::copy(coefficients.begin(), coefficients.end(), piece.c.begin());
  return piece;
}

// The path parameter is the time.
Trajectory make_trajectory(const Knots & knots, const std::vector<double> & times)
{
  auto path = std::make_shared<Path>();
  auto motion = std::make_shared<Motion>();
  for (std::size_t i = 0; i < knots.widths.size(); ++i) {
    path->pieces.push_back(quintic(knots, i, times[i]));
    motion->timing.push_back({times[i], knots.widths[i], i, {0.0, 1.0, 0.0, 0.0, 0.0, 0.0}});
  }
  if (path->pieces.empty()) {
    path->pieces.emplace_back().c[0] = knots.q.front();
  }
  path->waypoints = times;
  motion->path = std::move(path);
  return Trajectory(std::move(motion));
}

bool are_close(const TimedWaypoints & waypoints, std::size_t first, std::size_t second)
{
  constexpr double same_position = 1e-3;  // rad
  const double step = waypoints.times[second] - waypoints.times[first];
  const auto & a = waypoints.positions[first];
  const auto & b = waypoints.positions[second];
  return step > 0.0 && step < shortest_step &&
         std::equal(
             a.begin(), a.end(), b.begin(), b.end(),
             [](double x, double y) { return std::abs(x - y) <= same_position; });
}

template <typename T>
void keep(std::vector<T> & list, const std::vector<std::size_t> & kept)
{
  if (list.empty()) {
    return;
  }
  std::vector<T> result;
  result.reserve(kept.size());
  for (const std::size_t i : kept) {
    result.push_back(std::move(list[i]));
  }
  list = std::move(result);
}

}  // namespace

Status check_timed(const TimedWaypoints & waypoints, const Limits & limits)
{
  if (auto status = check(limits); !status) {
    return status;
  }
  const auto knots = read_given(waypoints, limits);
  if (!knots) {
    return tl::unexpected(knots.error());
  }
  for (std::size_t i = 0; i < knots->q.size(); ++i) {
    if (!check_positions("positions", knots->q[i], limits)) {
      return check_positions(fmt::format("positions[{}]", i), knots->q[i], limits);
    }
  }
  return {};
}

void drop_close_waypoints(TimedWaypoints & waypoints)
{
  const std::size_t count = waypoints.times.size();
  for (const auto * list : {&waypoints.positions, &waypoints.velocities, &waypoints.accelerations}) {
    if (!list->empty() && list->size() != count) {
      return;
    }
  }
  if (count < 3 || waypoints.positions.empty()) {
    return;
  }
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i + 1 < count; ++i) {
    if (!are_close(waypoints, kept.back(), i)) {
      kept.push_back(i);
    }
  }
  if (kept.size() > 1 && are_close(waypoints, kept.back(), count - 1)) {
    kept.pop_back();
  }
  kept.push_back(count - 1);
  keep(waypoints.times, kept);
  for (auto * list : {&waypoints.positions, &waypoints.velocities, &waypoints.accelerations}) {
    keep(*list, kept);
  }
}

void prepend_start(TimedWaypoints & waypoints, const Joints & start)
{
  if (waypoints.times.empty() || !(waypoints.times.front() >= shortest_step)) {
    return;
  }
  waypoints.times.insert(waypoints.times.begin(), 0.0);
  waypoints.positions.insert(waypoints.positions.begin(), {start.begin(), start.end()});
  for (auto * list : {&waypoints.velocities, &waypoints.accelerations}) {
    if (!list->empty()) {
      list->insert(list->begin(), std::vector<double>(joint_count, 0.0));
    }
  }
}

Expected<Trajectory> plan_timed(const TimedWaypoints & waypoints, const Limits & limits)
{
  if (auto status = check(limits); !status) {
    return tl::unexpected(status.error());
  }
  auto knots = read_knots(waypoints, limits);
  if (!knots) {
    return tl::unexpected(knots.error());
  }
  Trajectory trajectory = make_trajectory(*knots, waypoints.times);
  if (const auto verified = trajectory.verify(limits); !verified) {
    return tl::unexpected(Error{
        verified.error().code, verified.error().message + ": give the waypoints more time, or other limits"});
  }
  return trajectory;
}

}  // namespace ur_ros_rtde::trajectory
