#include <ur_ros_rtde_msgs/action/pose_trans.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class PoseTrans : public QueryCommand<ur_ros_rtde_msgs::action::PoseTrans> {
  void check(const Goal & goal, Check & check) const override
  {
    check.frame("p_from", goal.p_from).frame("p_from_to", goal.p_from_to).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().pose = query(run, [&](auto & control) {
      return to_pose(control.poseTrans(to_ur(goal.p_from), to_ur(goal.p_from_to)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(PoseTrans, "pose_trans")

}  // namespace ur_ros_rtde
