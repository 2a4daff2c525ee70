#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {
namespace {
const std::vector<std::string> roles{"programmer", "operator", "none", "locked", "restricted"};
}  // namespace

class SetUserRole : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Limits limits() const override { return {never, {3, 1}, roles}; }
  Request request(const Goal & goal) const override
  {
    return {"setUserRole " + goal.text, "Setting user role"};
  }
};

UR_ROS_RTDE_EXPORT(SetUserRole, "dashboard/set_user_role")

}  // namespace ur_ros_rtde
