#include <ur_ros_rtde_msgs/action/get_flag.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class IsSteady : public QueryCommand<ur_ros_rtde_msgs::action::GetFlag> {
  void check(const Goal &, Check & check) const override { check.answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().value = query(run, [](auto & control) { return control.isSteady(); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsSteady, "is_steady")

}  // namespace ur_ros_rtde
