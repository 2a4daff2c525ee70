#include "operation/run_steps.hpp"
#include "operation/startup_sequence.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MakeReady : public Command<ur_ros_rtde_msgs::action::MakeReady> {
  CommandTraits traits() const override { return {.resource = Resource::none, .allowed_in_any_state = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.above_zero("timeout", goal.timeout, 600.0, "s");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    StartupSequence startup(run, goal);
    return run_steps(run, goal.timeout, [&] { return startup.step(); });
  }
};

UR_ROS_RTDE_EXPORT(MakeReady, "make_ready")

}  // namespace ur_ros_rtde
