#include "force/hand_guiding/hand_guiding.hpp"

namespace ur_ros_rtde {

class Freedrive : public Command<ur_ros_rtde_msgs::action::Freedrive> {
  void check(const Goal & goal, Check & check) const override { check_freedrive(goal, true, check); }

  Outcome run(const Goal & goal, Run & run) override
  {
    Mode mode = start_freedrive(run, goal);
    return end_mode_after(run, goal.duration, mode);
  }
};

UR_ROS_RTDE_EXPORT(Freedrive, "freedrive")

}  // namespace ur_ros_rtde
