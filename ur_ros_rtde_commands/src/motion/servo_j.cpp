#include <ur_ros_rtde_msgs/action/servo_j.hpp>

#include "servo.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ServoJ : public Command<ur_ros_rtde_msgs::action::ServoJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions);
    if (check_servo(goal, check).ok() && goal.time > 0.0) {
      check.reachable_in("joint_positions", goal.joint_positions, goal.time, smooth_step_peak);
    }
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_q;
    const double time = goal.time > 0.0 ? goal.time : slow_joint_time(start, goal.joint_positions);
    const auto send = [&](double share, double cycle) {
      const auto target = joints_between(start, goal.joint_positions, share);
      run.control()->servoJ(target, 0.0, 0.0, cycle, goal.lookahead_time, goal.gain);
    };
    const auto arrival = [&] { return run.until_at_joints(goal.joint_positions); };
    return servo(run, time, send, arrival, goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(ServoJ, "servo_j")

}  // namespace ur_ros_rtde
