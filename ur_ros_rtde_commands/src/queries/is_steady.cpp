#include <ur_ros_rtde_msgs/action/get_flag.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class IsSteady : public Question<ur_ros_rtde_msgs::action::GetFlag> {
  void check(const Goal &, Check & check) const override { check.answers(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().value = answer(run, [](auto & control) { return control.isSteady(); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsSteady, "is_steady")

}  // namespace ur_ros_rtde
