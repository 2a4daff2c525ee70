#include "force/hand_guiding/hand_guiding.hpp"

namespace ur_ros_rtde {

class FreedriveStart : public Command<ur_ros_rtde_msgs::action::Freedrive> {
  CommandTraits traits() const override
  {
    return {.leaves_mode_active = true, .switches_hand_guiding = true};
  }

  void check(const Goal & goal, Check & check) const override { check_freedrive(goal, false, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    start_freedrive(run, goal).keep_on();
    return Outcome::success("the arm can be moved by hand until freedrive_stop or stop");
  }
};

UR_ROS_RTDE_EXPORT(FreedriveStart, "freedrive_start")

}  // namespace ur_ros_rtde
