#include <array>
#include <ur_ros_rtde_msgs/action/get_integer.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr std::array<const char *, 3> meanings{
    "normal", "near a singularity", "too close to a singularity: the arm is hard to move in freedrive"};
}  // namespace

class GetFreedriveStatus : public QueryCommand<ur_ros_rtde_msgs::action::GetInteger> {
  void check(const Goal &, Check & check) const override { check.polyscope(10).answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    const int status = query(run, [](auto & control) { return control.getFreedriveStatus(); });
    run.result().value = status;
    run.result().text = status >= 0 && status <= 2 ? meanings[static_cast<std::size_t>(status)] : "unknown";
    return Outcome::success(run.result().text);
  }
};

UR_ROS_RTDE_EXPORT(GetFreedriveStatus, "get_freedrive_status")

}  // namespace ur_ros_rtde
