#include <ur_ros_rtde_msgs/action/enable_external_ft_sensor.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Enables or disables an external force-torque sensor with one of ur_rtde's two functions for this.
class ExternalFtSensorCommand : public Command<ur_ros_rtde_msgs::action::EnableExternalFtSensor> {
 public:
  using Function = bool (ur_rtde::RTDEControlInterface::*)(bool, double, const std::vector<double> &,
                                                           const std::vector<double> &);
  explicit ExternalFtSensorCommand(Function enable) : enable_(enable) {}

  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("sensor_mass", goal.sensor_mass, 0.0, 10.0, "kg")
        .vector("sensor_offset", goal.sensor_offset, 1.0, "m")
        .vector("sensor_center_of_gravity", goal.sensor_center_of_gravity, 1.0, "m");
  }

 private:
  Outcome run(const Goal & goal, Run & run) override
  {
    const auto & offset = goal.sensor_offset;
    const auto & cog = goal.sensor_center_of_gravity;
    const auto control = run.control().hold();
    check_result(((*control).*enable_)(goal.enable, goal.sensor_mass, {offset.x, offset.y, offset.z},
                                       {cog.x, cog.y, cog.z}),
                 "switch the external sensor");
    return Outcome::success();
  }

  const Function enable_;
};

class EnableExternalFtSensor : public ExternalFtSensorCommand {
 public:
  EnableExternalFtSensor() : ExternalFtSensorCommand(&ur_rtde::RTDEControlInterface::enableExternalFtSensor)
  {
  }
};

UR_ROS_RTDE_EXPORT(EnableExternalFtSensor, "enable_external_ft_sensor")

class FtRtdeInputEnable : public ExternalFtSensorCommand {
 public:
  FtRtdeInputEnable() : ExternalFtSensorCommand(&ur_rtde::RTDEControlInterface::ftRtdeInputEnable) {}

  void check(const Goal & goal, Check & check) const override
  {
    ExternalFtSensorCommand::check(goal, check);
    check.polyscope(10);
  }
};

UR_ROS_RTDE_EXPORT(FtRtdeInputEnable, "ft_rtde_input_enable")

}  // namespace ur_ros_rtde
