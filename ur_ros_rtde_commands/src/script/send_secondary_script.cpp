#include <algorithm>

#include "script/script_goal.hpp"

namespace ur_ros_rtde {
namespace {
/// s. A secondary program must not take any time of the controller, so its end or an error follows at once.
constexpr double max_secondary_timeout = 2.0;
}  // namespace

class SendSecondaryScript : public Command<SendScriptAction> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override { check_script_goal(goal, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return run_script_goal(goal, run, ScriptKind::secondary, std::min(goal.timeout, max_secondary_timeout));
  }
};

UR_ROS_RTDE_EXPORT(SendSecondaryScript, "send_secondary_script")

}  // namespace ur_ros_rtde
