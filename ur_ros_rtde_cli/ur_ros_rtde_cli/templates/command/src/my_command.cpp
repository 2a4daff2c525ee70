#include <my_package/action/my_command.hpp>
#include <ur_ros_rtde/command.hpp>

namespace my_package {

class MyCommand : public ur_ros_rtde::Command<action::MyCommand> {
  // Rejects an invalid goal with the first violation, before anything moves.
  void check(const Goal & goal, ur_ros_rtde::Check & check) const override
  {
    check.in_range("angle", goal.angle, 0.01, 1.0, "rad").above_zero("speed", goal.speed, 3.14, "rad/s");
  }

  // Runs in the goal's own thread. What it has started is stopped before the result is sent.
  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    const auto start = run.receive()->getActualQ();
    auto there = start;
    there[5] += goal.angle;
    run.control()->moveJ(there, goal.speed, 1.0, true);  // asynchronous: never block
    if (auto outcome = run.until_joints_reached(there); !outcome) {
      return outcome;
    }
    run.control()->moveJ(start, goal.speed, 1.0, true);
    return run.until_joints_reached(start);
  }
};

UR_ROS_RTDE_EXPORT(MyCommand, "my_command")

}  // namespace my_package
