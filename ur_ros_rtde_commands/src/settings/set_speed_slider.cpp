#include <cmath>
#include <ur_ros_rtde_msgs/action/set_speed_slider.hpp>

#include "settings/setting_helpers.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SetSpeedSlider : public Command<ur_ros_rtde_msgs::action::SetSpeedSlider> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    // A robot that leaves 0 has made a protective stop (Universal_Robots_Client_Library, issue 58).
    check.in_range("fraction", goal.fraction, 0.01, 1.0);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (!run.io()->setSpeedSlider(goal.fraction)) {
      return send_failure();
    }
    const auto is_set = [&] { return std::abs(run.state().target_speed_fraction - goal.fraction) < 0.01; };
    return run.expect(is_set, std::chrono::seconds(1), "the robot still reports another speed");
  }
};

UR_ROS_RTDE_EXPORT(SetSpeedSlider, "set_speed_slider")

}  // namespace ur_ros_rtde
