#include <algorithm>
#include <ur_ros_rtde_msgs/action/tool_contact.hpp>

#include "contact.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ToolContact : public Command<ur_ros_rtde_msgs::action::ToolContact> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_direction(check, goal.direction).polyscope(min_contact_polyscope).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().steps = std::max(0, contact_steps(run, to_ur(goal.direction)));
    run.result().contact = run.result().steps > 0;
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(ToolContact, "tool_contact")

}  // namespace ur_ros_rtde
