#include <ur_ros_rtde_msgs/action/enable_external_ft_sensor.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

class FtRtdeInputEnable : public Command<ur_ros_rtde_msgs::action::EnableExternalFtSensor> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("sensor_mass", goal.sensor_mass, 0.0, 10.0, "kg")
        .vector("sensor_offset", goal.sensor_offset, 1.0, "m")
        .vector("sensor_center_of_gravity", goal.sensor_center_of_gravity, 1.0, "m")
        .polyscope(9);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto & at = goal.sensor_offset;
    const auto & cog = goal.sensor_center_of_gravity;
    must_do(run.control()->ftRtdeInputEnable(goal.enable, goal.sensor_mass, {at.x, at.y, at.z},
                                             {cog.x, cog.y, cog.z}),
            "switch the external sensor");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(FtRtdeInputEnable, "ft_rtde_input_enable")

}  // namespace ur_ros_rtde
