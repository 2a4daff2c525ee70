#include "force/force_settings.hpp"

namespace ur_ros_rtde {

class ForceMode : public Command<ur_ros_rtde_msgs::action::ForceMode> {
  void check(const Goal & goal, Check & check) const override { check_force_mode(goal, true, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    start_force_mode(goal, run);
    const auto why = last_for(run, goal.duration, [&](const Sample & now) {
      const Vector6 & felt = now.actual_tcp_force;
      auto & wrench = run.feedback().wrench;
      wrench.force.x = felt[0], wrench.force.y = felt[1], wrench.force.z = felt[2];
      wrench.torque.x = felt[3], wrench.torque.y = felt[4], wrench.torque.z = felt[5];
    });
    if (why) {
      return *why;
    }
    must_do(run.control()->forceModeStop(), "end force mode");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(ForceMode, "force_mode")

}  // namespace ur_ros_rtde
