// Verifies and measures the planner: trajectory_bench [PATHS=10000] [FIRST=0]. Prints how many random paths
// were planned, the largest utilization of each limit by finite differences at 10 kHz, the largest distance
// to a waypoint beyond its tolerance, and planning times.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>
#include <vector>

#include "checks.hpp"
#include "random_paths.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

using namespace ur_ros_rtde::trajectory;
using ur_ros_rtde::default_joint_acceleration;
using ur_ros_rtde::default_joint_speed;

namespace {

/// CPU time of this thread in ms.
double processor_time()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Totals {
  int planned = 0, failed = 0, beyond = 0;
  Utilization use;
  double miss = 0.0, end_speed = 0.0;
  std::vector<double> ms_per_waypoint;

  void add(const Totals & other)
  {
    planned += other.planned;
    failed += other.failed;
    beyond += other.beyond;
    use.velocity = std::max(use.velocity, other.use.velocity);
    use.acceleration = std::max(use.acceleration, other.use.acceleration);
    use.jerk = std::max(use.jerk, other.use.jerk);
    miss = std::max(miss, other.miss);
    end_speed = std::max(end_speed, other.end_speed);
    ms_per_waypoint.insert(ms_per_waypoint.end(), other.ms_per_waypoint.begin(), other.ms_per_waypoint.end());
  }
};

void check_random_path(unsigned seed, bool jerk, Totals & totals)
{
  const auto path = test::random_path(seed);
  const Limits limits = test::random_limits(seed, jerk);
  const double begin = processor_time();
  const auto plan = plan_path(path.waypoints, limits, path.options);
  totals.ms_per_waypoint.push_back((processor_time() - begin) / static_cast<double>(path.waypoints.size()));
  if (!plan) {
    ++totals.failed;
    std::printf("seed %u (%s): %s\n", seed, path.kind.c_str(), plan.error().message.c_str());
    return;
  }
  ++totals.planned;
  const Utilization use = test::finite_difference_utilization(*plan, limits);
  const double miss = test::max_waypoint_deviation(*plan, path.waypoints) - path.options.blend_tolerance;
  totals.use.velocity = std::max(totals.use.velocity, use.velocity);
  totals.use.acceleration = std::max(totals.use.acceleration, use.acceleration);
  totals.use.jerk = std::max(totals.use.jerk, use.jerk);
  totals.miss = std::max(totals.miss, miss);
  totals.end_speed = std::max(totals.end_speed, test::speed_at_ends(*plan));
  if (std::max({use.velocity, use.acceleration, use.jerk}) > 1.0 || miss > 1e-8) {
    ++totals.beyond;
    std::printf("seed %u (%s): use %.5f %.5f %.5f, miss %.3g\n", seed, path.kind.c_str(), use.velocity,
                use.acceleration, use.jerk, miss);
  }
}

void random_paths(unsigned first, unsigned count, bool jerk)
{
  const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<Totals> parts(threads);
  {
    std::vector<std::jthread> workers;
    for (unsigned part = 0; part < threads; ++part) {
      workers.emplace_back([&, part] {
        for (unsigned seed = first + part; seed < first + count; seed += threads) {
          check_random_path(seed, jerk, parts[part]);
        }
      });
    }
  }
  Totals totals;
  for (const Totals & part : parts) {
    totals.add(part);
  }
  std::sort(totals.ms_per_waypoint.begin(), totals.ms_per_waypoint.end());
  std::printf(
      "%s jerk limits: %d planned, %d rejected, %d beyond a limit or tolerance; largest use: velocity %.5f, "
      "acceleration %.5f, jerk %.5f; miss beyond the tolerance %.2g rad; speed at the ends %.2g rad/s; "
      "processor time per waypoint: median %.3f ms, worst %.3f ms\n",
      jerk ? "with" : "without", totals.planned, totals.failed, totals.beyond, totals.use.velocity,
      totals.use.acceleration, totals.use.jerk, totals.miss, totals.end_speed,
      totals.ms_per_waypoint[totals.ms_per_waypoint.size() / 2], totals.ms_per_waypoint.back());
}

Limits same_limits(double velocity, double acceleration)
{
  Limits limits;
  limits.velocity.setConstant(velocity);
  limits.acceleration.setConstant(acceleration);
  limits.jerk.setConstant(default_jerk);
  return limits;
}

void planning_time(const char * what, const std::vector<Joints> & waypoints, const PathOptions & options,
                   const Limits & limits = same_limits(3.14, default_acceleration))
{
  double best = 1e9;
  double duration = 0.0;
  for (int round = 0; round < 5; ++round) {
    const double begin = processor_time();
    const auto plan = plan_path(waypoints, limits, options);
    best = std::min(best, processor_time() - begin);
    duration = plan ? plan->duration() : -1.0;
  }
  std::printf("%s, %zu waypoints: planned in %.1f ms (motion of %.1f s)\n", what, waypoints.size(), best,
              duration);
}

// Measures stops from 200 moments of random plans.
void stops()
{
  std::vector<double> ms;
  std::vector<double> seconds;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto path = test::random_path(seed);
    const Limits limits = test::random_limits(seed, true);
    const auto plan = plan_path(path.waypoints, limits, path.options);
    for (int part = 1; plan && part < 6; ++part) {
      const double time = plan->duration() * part / 6.0;
      const double begin = processor_time();
      const Trajectory stop = *plan->stop_from(time, limits, test::no_deadline);
      ms.push_back(processor_time() - begin);
      seconds.push_back(stop.duration() - time);
    }
  }
  std::sort(ms.begin(), ms.end());
  std::sort(seconds.begin(), seconds.end());
  std::printf(
      "stops along the path: computed in median %.2f ms, worst %.2f ms; at rest after median %.3f s, worst "
      "%.3f s\n",
      ms[ms.size() / 2], ms.back(), seconds[seconds.size() / 2], seconds.back());
}

std::vector<Joints> curve(int count)
{
  std::vector<Joints> points;
  for (int i = 0; i < count; ++i) {
    Joints q;
    for (int j = 0; j < joint_count; ++j) {
      q[j] = std::sin(0.01 * (1.0 + 0.3 * j) * i + j);
    }
    points.push_back(q);
  }
  return points;
}

std::vector<Joints> jumps(int count, double size = 1.0)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> between(-size, size);
  std::vector<Joints> points(static_cast<std::size_t>(count));
  for (Joints & q : points) {
    for (double & value : q) {
      value = between(random);
    }
  }
  return points;
}

}  // namespace

int main(int argc, char ** argv)
{
  const auto count = static_cast<unsigned>(argc > 1 ? std::atoi(argv[1]) : 10000);
  const auto first = static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 0);
  planning_time("smooth curve, through every waypoint", curve(1000), {});
  planning_time("smooth curve, blended within 0.01 rad", curve(1000), {.blend_tolerance = 0.01});
  planning_time("jumps, a stop at every waypoint", jumps(1000), {});
  planning_time("jumps, blended within 0.05 rad", jumps(1000), {.blend_tolerance = 0.05});
  const Limits slow = same_limits(default_joint_speed, default_joint_acceleration);
  for (const int waypoints : {3, 10, 120}) {
    planning_time("long jumps at default speed, blended within 0.05 rad", jumps(waypoints, 2.0),
                  {.blend_tolerance = 0.05}, slow);
  }
  stops();
  for (const bool jerk : {true, false}) {
    if (count == 0) {
      break;
    }
    random_paths(first, count, jerk);
  }
  return 0;
}
