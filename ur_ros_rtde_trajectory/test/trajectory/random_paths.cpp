#include "random_paths.hpp"

#include <cmath>
#include <numbers>

#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

using Random = std::mt19937;

double between(Random & random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Joints joints_between(Random & random, double low, double high)
{
  Joints q;
  for (int j = 0; j < joint_count; ++j) {
    q[j] = between(random, low, high);
  }
  return q;
}

std::vector<Joints> jumps(Random & random, int count)
{
  const double size = std::pow(10.0, between(random, -1.5, 0.3));
  std::vector<Joints> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(joints_between(random, -size, size));
  }
  return points;
}

// Harmonics of a different frequency in each joint, sampled as densely as motion planners do.
std::vector<Joints> curve(Random & random, int count)
{
  const Joints size = joints_between(random, 0.1, 1.2);
  const Joints frequency = joints_between(random, 0.2, 1.5);
  const Joints phase = joints_between(random, 0.0, 2.0 * std::numbers::pi);
  const double step = 4.0 / std::max(count, 40);
  std::vector<Joints> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(size * (2.0 * frequency * step * i + phase).sin());
  }
  return points;
}

std::vector<Joints> walk(Random & random, int count)
{
  std::vector<Joints> points{joints_between(random, -1.0, 1.0)};
  Joints heading = joints_between(random, -1.0, 1.0);
  while (static_cast<int>(points.size()) < count) {
    heading = 0.8 * heading + 0.2 * joints_between(random, -1.0, 1.0);
    const Joints next = points.back() + heading * std::pow(10.0, between(random, -3.0, -0.5));
    points.push_back(next.max(-6.0).min(6.0));
  }
  return points;
}

std::vector<Joints> lines(Random & random, int count)
{
  std::vector<Joints> points{joints_between(random, -1.0, 1.0)};
  while (static_cast<int>(points.size()) < count) {
    const int what = std::uniform_int_distribution<int>(0, 5)(random);
    if (what == 0) {
      points.push_back(points.back());
    } else if (what == 1 && points.size() > 1) {
      points.push_back(points[points.size() - 2]);
    } else if (what == 2 && points.size() > 1) {
      points.push_back(
          (points.back() + 0.3 * (points.back() - points[points.size() - 2])).max(-6.0).min(6.0));
    } else {
      points.push_back(joints_between(random, -1.0, 1.0));
    }
  }
  return points;
}

}  // namespace

RandomPath random_path(unsigned seed)
{
  Random random(seed);
  const int count = static_cast<int>(std::round(2.0 * std::pow(100.0, between(random, 0.0, 1.0))));
  RandomPath path;
  switch (seed % 4) {
    case 0:
      path = {"jumps", jumps(random, count), {}};
      break;
    case 1:
      path = {"curve", curve(random, count), {}};
      break;
    case 2:
      path = {"walk", walk(random, count), {}};
      break;
    default:
      path = {"lines", lines(random, count), {}};
  }
  if (between(random, 0.0, 1.0) < 0.6) {
    path.options.blend_tolerance = std::pow(10.0, between(random, -3.0, -0.5));
  }
  return path;
}

namespace {

using Source = std::mt19937_64;

bool one_in(Source & random, unsigned long count)
{
  return random() % count == 0;
}

double uniform(Source & random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

// All orders of magnitude are equally likely.
double any_size(Source & random, double low, double high)
{
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

Joints any_limits(Source & random, double highest)
{
  if (one_in(random, 2)) {
    return Joints::Constant(any_size(random, 1e-2, highest));
  }
  Joints limits;
  for (double & limit : limits) {
    limit = any_size(random, 1e-2, highest);
  }
  return limits;
}

Limits extreme_limits(Source & random)
{
  static const std::string models[]{"ur3e", "ur5e", "ur10e", "ur20", "ur30", "ur5"};
  Limits limits = default_speed_limits(make_limits(arm_limits(models[random() % std::size(models)]).value()));
  if (one_in(random, 2)) {
    limits.velocity = limits.velocity.min(any_limits(random, 10.0));
  }
  if (one_in(random, 2)) {
    limits.acceleration = any_limits(random, 40.0);
  }
  if (one_in(random, 2)) {
    limits.jerk = any_limits(random, 1e4);
  }
  return limits;
}

Joints next_waypoint(Source & random, const std::vector<Joints> & points, double scale)
{
  Joints next = points.back();
  const unsigned long kind = random() % 6;
  if (kind == 0) {  // nearly the same point
    for (double & value : next) {
      value += any_size(random, 1e-10, 1e-3) * (one_in(random, 2) ? 1.0 : -1.0);
    }
  } else if (kind == 1) {  // one joint
    next[static_cast<int>(random() % joint_count)] += scale * uniform(random, -1.0, 1.0);
  } else if (kind == 2 && points.size() > 1) {  // back
    next = points[points.size() - 2];
  } else if (kind == 3 && points.size() > 1) {  // straight on
    next += (next - points[points.size() - 2]) * uniform(random, 0.1, 1.0);
  } else {
    for (double & value : next) {
      value += scale * uniform(random, -1.0, 1.0);
    }
  }
  return (next.abs() < 3.0).all() ? next : Joints(0.9 * points.back());
}

}  // namespace

RandomPlan extreme_plan(unsigned long seed)
{
  Source random(seed);
  RandomPlan plan;
  plan.limits = extreme_limits(random);
  const std::size_t count = 2 + random() % (one_in(random, 40) ? 119 : 11);
  const double scale = any_size(random, 1e-3, 1.0);
  plan.waypoints.emplace_back();
  for (double & value : plan.waypoints.back()) {
    value = uniform(random, -2.5, 2.5);
  }
  while (plan.waypoints.size() < count) {
    plan.waypoints.push_back(next_waypoint(random, plan.waypoints, scale));
  }
  plan.options.blend_tolerance = one_in(random, 4) ? 0.0 : any_size(random, 1e-7, 1.0);
  if (one_in(random, 2)) {
    plan.options.corner_angle = uniform(random, 0.0, 3.14);
  }
  if (one_in(random, 4)) {
    plan.options.speed_fraction = any_size(random, 1e-2, 1.0);
  }
  return plan;
}

Limits random_limits(unsigned seed, bool with_jerk)
{
  static const double speeds[][joint_count] = {{180, 180, 180, 360, 360, 360},
                                               {180, 180, 180, 180, 180, 180},
                                               {120, 120, 180, 180, 180, 180},
                                               {120, 120, 180, 180, 180, 180},
                                               {120, 120, 150, 210, 210, 210}};
  Random random(seed + 1000003U);
  Limits limits;
  limits.position_min.setConstant(-2.0 * std::numbers::pi);
  limits.position_max.setConstant(2.0 * std::numbers::pi);
  limits.velocity = Eigen::Map<const Joints>(speeds[seed % 5]) * std::numbers::pi / 180.0;
  limits.acceleration = joints_between(random, 1.0, 15.0);
  if (with_jerk) {
    limits.jerk = limits.acceleration * joints_between(random, 5.0, 30.0);
  }
  return limits;
}

}  // namespace ur_ros_rtde::trajectory::test
