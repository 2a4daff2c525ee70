#include <ur_ros_rtde_msgs/action/servo_l.hpp>

#include "servo.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ServoL : public Command<ur_ros_rtde_msgs::action::ServoL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose);
    check_servo(goal, check).reachable("pose", goal.pose);
    if (check.ok()) {
      check_tcp_speed(check, to_ur(goal.pose), goal.time);
    }
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_tcp_pose;
    const auto end = to_ur(goal.pose);
    const auto send = [&](double share, double cycle) {
      const auto target = pose_between(start, end, share);
      run.control()->servoL(target, 0.0, 0.0, cycle, goal.lookahead_time, goal.gain);
    };
    return servo(run, goal.time, send, [&] { return run.until_at_pose(end); }, goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(ServoL, "servo_l")

}  // namespace ur_ros_rtde
