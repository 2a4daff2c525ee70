#include <ur_ros_rtde_msgs/action/move_until_contact.hpp>

#include "contact.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MoveUntilContact : public Command<ur_ros_rtde_msgs::action::MoveUntilContact> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.twist("twist", goal.twist)
        .vector("direction", goal.direction, any_length)
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .above_zero("timeout", goal.timeout, 3600.0, "s")
        .above_zero("distance", goal.distance, 3.0, "m")
        .polyscope(min_contact_polyscope);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const ContactMotion motion{goal.twist,   goal.direction, goal.acceleration,
                               goal.timeout, goal.distance,  goal.retract};
    return move_until_contact(run, motion, [&](const auto & where) {
      run.result().contact = true;
      run.result().contact_state = where;
    });
  }
};

UR_ROS_RTDE_EXPORT(MoveUntilContact, "move_until_contact")

}  // namespace ur_ros_rtde
