#include <ur_ros_rtde_msgs/action/teach_mode.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

class TeachMode : public Command<ur_ros_rtde_msgs::action::TeachMode> {
  void check(const Goal & goal, Check & check) const override { check_end_of_mode(check, goal, true); }

  Outcome run(const Goal & goal, Run & run) override
  {
    Mode mode = start_teach_mode(run);
    return end_mode_after(run, goal.duration, mode);
  }
};

UR_ROS_RTDE_EXPORT(TeachMode, "teach_mode")

}  // namespace ur_ros_rtde
