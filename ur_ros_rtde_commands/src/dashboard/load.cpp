#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {
namespace {
/// programState tells the name without its folder.
std::string file_name(const std::string & path)
{
  return path.substr(path.find_last_of('/') + 1);
}
}  // namespace

class Load : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Request request(const Goal & goal) const override
  {
    return {"load " + goal.text, "Loading program: ", {"programState", {"STOPPED " + file_name(goal.text)}}};
  }
};

UR_ROS_RTDE_EXPORT(Load, "dashboard/load")

}  // namespace ur_ros_rtde
