#include <algorithm>

#include "script/given_script.hpp"

namespace ur_ros_rtde {
namespace {
/// A secondary program must not take time: s in which its end, or an error, comes.
constexpr double longest_wait = 2.0;
}  // namespace

class SendSecondaryScript : public Command<SendScriptAction> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override { check_script(goal, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return run_given(goal, run, ScriptKind::secondary, std::min(goal.timeout, longest_wait));
  }
};

UR_ROS_RTDE_EXPORT(SendSecondaryScript, "send_secondary_script")

}  // namespace ur_ros_rtde
