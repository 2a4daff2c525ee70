#include "force/hand_guiding/hand_guiding.hpp"

#include <algorithm>

namespace ur_ros_rtde {
namespace {
bool is_zero(const geometry_msgs::msg::Quaternion & q)
{
  return q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;
}
}  // namespace

void check_freedrive(const ur_ros_rtde_msgs::action::Freedrive::Goal & goal, bool ends_with_goal,
                     Check & check)
{
  check.that(std::any_of(goal.free_axes.begin(), goal.free_axes.end(), [](bool axis) { return axis; }),
             "free_axes is false for all axes: at least one axis has to be true");
  if (!is_zero(goal.feature.orientation)) {
    check.frame("feature", goal.feature);
  }
  check_end_of_mode(check, goal, ends_with_goal).polyscope(10);
}

Mode start_freedrive(Run & run, const ur_ros_rtde_msgs::action::Freedrive::Goal & goal)
{
  const std::vector<double> base(6, 0.0);
  return start_freedrive(run, goal.free_axes, is_zero(goal.feature.orientation) ? base : to_ur(goal.feature));
}

}  // namespace ur_ros_rtde
