#include <array>
#include <string>
#include <ur_ros_rtde_msgs/action/get_integer.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {
namespace {
/// The bits of the RTDE field robot_status_bits.
constexpr std::array<const char *, 4> bit_names{"power on", "program running", "teach button pressed",
                                                "power button pressed"};
}  // namespace

class GetRobotStatus : public QueryCommand<ur_ros_rtde_msgs::action::GetInteger> {
  Outcome run(const Goal &, Run & run) override
  {
    const std::uint32_t bits = run.state().robot_status_bits;
    run.result().value = bits;
    for (std::size_t i = 0; i < bit_names.size(); ++i) {
      if (((bits >> i) & 1U) != 0) {
        run.result().text += (run.result().text.empty() ? "" : ", ") + std::string(bit_names[i]);
      }
    }
    return Outcome::success(run.result().text);
  }
};

UR_ROS_RTDE_EXPORT(GetRobotStatus, "get_robot_status")

}  // namespace ur_ros_rtde
