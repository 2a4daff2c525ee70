#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GenerateFlightReport : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Limits limits() const override { return {{5, 8}, {3, 13}, {"controller", "software", "system"}}; }
  Request request(const Goal & goal) const override
  {
    return {"generate flight report " + goal.text, "Flight Report generated with id", {}, 180.0};
  }
};

UR_ROS_RTDE_EXPORT(GenerateFlightReport, "dashboard/generate_flight_report")

}  // namespace ur_ros_rtde
