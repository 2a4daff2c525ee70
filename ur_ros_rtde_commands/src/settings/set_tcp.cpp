#include <algorithm>
#include <ur_ros_rtde_msgs/action/set_tcp.hpp>

#include "settings/setting_helpers.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double tolerance = 1e-5;  // m, rad

/// The distance (m) or the angle (rad) between two poses, whichever is greater.
double pose_difference(const std::vector<double> & a, const std::vector<double> & b)
{
  Vector6 first;
  Vector6 second;
  std::copy_n(a.begin(), 6, first.begin());
  std::copy_n(b.begin(), 6, second.begin());
  const Vector6 offset = pose_trans(pose_inverse(first), second);
  return std::max(std::hypot(offset[0], offset[1], offset[2]), std::hypot(offset[3], offset[4], offset[5]));
}
}  // namespace

class SetTcp : public Command<ur_ros_rtde_msgs::action::SetTcp> {
  void check(const Goal & goal, Check & check) const override
  {
    const auto & p = goal.pose.position;
    check.in_range("pose.position.x", p.x, -10.0, 10.0, "m")
        .in_range("pose.position.y", p.y, -10.0, 10.0, "m")
        .in_range("pose.position.z", p.z, -10.0, 10.0, "m")
        .frame("pose", goal.pose);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> offset = to_ur(goal.pose);
    check_result(run.control()->setTcp(offset), "set the TCP");
    const auto is_set = [&] { return pose_difference(run.control()->getTCPOffset(), offset) < tolerance; };
    return run.expect(is_set, setting_timeout, "the robot still reports another TCP");
  }
};

UR_ROS_RTDE_EXPORT(SetTcp, "set_tcp")

}  // namespace ur_ros_rtde
