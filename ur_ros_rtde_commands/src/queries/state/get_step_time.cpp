#include <ur_ros_rtde_msgs/action/get_number.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetStepTime : public QueryCommand<ur_ros_rtde_msgs::action::GetNumber> {
  void check(const Goal &, Check & check) const override { check.polyscope(4).answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().value = query(run, [](auto & control) { return control.getStepTime(); });
    run.result().unit = "s";
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetStepTime, "get_step_time")

}  // namespace ur_ros_rtde
