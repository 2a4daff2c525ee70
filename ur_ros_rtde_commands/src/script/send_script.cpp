#include "script/script_goal.hpp"

namespace ur_ros_rtde {

class SendScript : public Command<SendScriptAction> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  void check(const Goal & goal, Check & check) const override { check_script_goal(goal, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return run_script_goal(goal, run, ScriptKind::program, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(SendScript, "send_script")

}  // namespace ur_ros_rtde
