#include <ur_ros_rtde_msgs/action/set_analog_output.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

class AnalogOutputCommand : public Command<ur_ros_rtde_msgs::action::SetAnalogOutput> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("pin", goal.pin, 0, 1).in_range("fraction", goal.fraction, 0.0, 1.0);
  }
};

class SetAnalogOutputCurrent : public AnalogOutputCommand {
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_analog_output(run, goal.pin, 0.004 + 0.016 * goal.fraction, 1e-4, "A",
                             [&](auto & io) { return io.setAnalogOutputCurrent(goal.pin, goal.fraction); });
  }
};

UR_ROS_RTDE_EXPORT(SetAnalogOutputCurrent, "set_analog_output_current")

class SetAnalogOutputVoltage : public AnalogOutputCommand {
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_analog_output(run, goal.pin, 10.0 * goal.fraction, 0.05, "V",
                             [&](auto & io) { return io.setAnalogOutputVoltage(goal.pin, goal.fraction); });
  }
};

UR_ROS_RTDE_EXPORT(SetAnalogOutputVoltage, "set_analog_output_voltage")

}  // namespace ur_ros_rtde
