#include "checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ur_ros_rtde::trajectory::test {

Utilization finite_difference_utilization(const Trajectory & trajectory, const Limits & limits, double rate)
{
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double h = 1.0 / rate;
  const auto count = static_cast<long>(std::ceil(trajectory.duration() * rate)) + 4;
  Utilization use;
  Joints q[4];
  q[0] = q[1] = q[2] = trajectory.sample(0.0).position;
  for (long k = 1; k < count; ++k) {
    const double time = static_cast<double>(k) * h;
    q[3] = trajectory.sample(time).position;
    const Joints velocity = (q[3] - q[2]) / h;
    const Joints acceleration = (q[3] - 2.0 * q[2] + q[1]) / (h * h);
    const Joints jerk = (q[3] - 3.0 * q[2] + 3.0 * q[1] - q[0]) / (h * h * h);
    // A position has the accuracy of the sums it is made of, and is taken at a time rounded to its last
    // digit.
    const Joints rounding = 8.0 * epsilon * (1.0 + q[3].abs() + velocity.abs() * time);
    use.velocity =
        std::max(use.velocity, ((velocity.abs() - 2.0 * rounding / h) / limits.velocity).maxCoeff());
    use.acceleration = std::max(
        use.acceleration, ((acceleration.abs() - 4.0 * rounding / (h * h)) / limits.acceleration).maxCoeff());
    use.jerk = std::max(use.jerk, ((jerk.abs() - 8.0 * rounding / (h * h * h)) / limits.jerk).maxCoeff());
    std::rotate(q, q + 1, q + 4);
  }
  return use;
}

double max_waypoint_deviation(const Trajectory & trajectory, const std::vector<Joints> & waypoints)
{
  double worst = 0.0;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Joints position = trajectory.sample(trajectory.time_of_waypoint(i)).position;
    worst = std::max(worst, (position - waypoints[i]).abs().maxCoeff());
  }
  return worst;
}

double speed_at_ends(const Trajectory & trajectory)
{
  const double inside = 1e-9;
  return std::max(trajectory.sample(inside).velocity.abs().maxCoeff(),
                  trajectory.sample(trajectory.duration() - inside).velocity.abs().maxCoeff());
}

}  // namespace ur_ros_rtde::trajectory::test
