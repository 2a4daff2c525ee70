#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GenerateSupportFile : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Limits limits() const override { return {{5, 8}, {3, 13}}; }
  Request request(const Goal & goal) const override
  {
    return {"generate support file " + goal.text, "Completed successfully", {}, 600.0};
  }
};

UR_ROS_RTDE_EXPORT(GenerateSupportFile, "dashboard/generate_support_file")

}  // namespace ur_ros_rtde
