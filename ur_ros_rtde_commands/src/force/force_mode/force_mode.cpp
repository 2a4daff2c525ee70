#include "force/force_mode/force_mode_helpers.hpp"

namespace ur_ros_rtde {

class ForceMode : public Command<ur_ros_rtde_msgs::action::ForceMode> {
  void check(const Goal & goal, Check & check) const override { check_force_mode(goal, true, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    Mode mode = start_force_mode(run, goal);
    const auto set_feedback = [&](const Sample & now) {
      const Vector6 & measured = now.actual_tcp_force;
      auto & wrench = run.feedback().wrench;
      wrench.force.x = measured[0];
      wrench.force.y = measured[1];
      wrench.force.z = measured[2];
      wrench.torque.x = measured[3];
      wrench.torque.y = measured[4];
      wrench.torque.z = measured[5];
    };
    return end_mode_after(run, goal.duration, mode, set_feedback);
  }
};

UR_ROS_RTDE_EXPORT(ForceMode, "force_mode")

}  // namespace ur_ros_rtde
