#include "force/hand_guiding/hand_guiding.hpp"

#include <algorithm>

namespace ur_ros_rtde {
namespace {
using Control = ur_rtde::RTDEControlInterface;

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
  check_duration(check, goal.duration, ends_with_goal).polyscope(10);
}

void start_freedrive(const ur_ros_rtde_msgs::action::Freedrive::Goal & goal, Run & run)
{
  check_modes_inactive(run, Control::MOTION_FORCE | Control::MOTION_TEACH | Control::MOTION_FREEDRIVE,
                       "freedrive");
  const std::vector<double> base(6, 0.0);
  const auto feature = is_zero(goal.feature.orientation) ? base : to_ur(goal.feature);
  check_result(run.control()->freedriveMode(to_int_flags(goal.free_axes), feature), "enter freedrive");
}

void start_teach_mode(Run & run)
{
  check_modes_inactive(run, Control::MOTION_FORCE | Control::MOTION_TEACH | Control::MOTION_FREEDRIVE,
                       "teach mode");
  check_result(run.control()->teachMode(), "enter teach mode");
}

}  // namespace ur_ros_rtde
