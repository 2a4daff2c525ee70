#include <ur_ros_rtde_msgs/action/servo_c.hpp>

#include "servo.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ServoC : public Command<ur_ros_rtde_msgs::action::ServoC> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("speed", goal.speed, 3.0, "m/s")
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .in_range("blend_radius", goal.blend_radius, 0.0, 2.0, "m")
        .in_range("deceleration", goal.deceleration, 0.1, 40.0, "rad/s^2")
        .reachable("pose", goal.pose);
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->servoC(to_ur(goal.pose), goal.speed, goal.acceleration, goal.blend_radius);
    return end_servo(run, run.until_at_pose(to_ur(goal.pose)), goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(ServoC, "servo_c")

}  // namespace ur_ros_rtde
