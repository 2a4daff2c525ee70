#include <ur_ros_rtde_msgs/action/set_digital_output.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

/// Sets one of `count` digital outputs. Pin 0 of the goal is the digital output `first` of the controller.
class DigitalOutputCommand : public Command<ur_ros_rtde_msgs::action::SetDigitalOutput> {
 public:
  DigitalOutputCommand(unsigned first, unsigned count) : first_(first), count_(count) {}

 private:
  CommandTraits traits() const override { return {.resource = Resource::none}; }
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("pin", goal.pin, 0, count_ - 1);
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_digital_output(run, first_ + goal.pin, goal.state);
  }

  const unsigned first_;
  const unsigned count_;
};

class SetDigitalOutput : public DigitalOutputCommand {
 public:
  SetDigitalOutput() : DigitalOutputCommand(0, 18) {}
};

UR_ROS_RTDE_EXPORT(SetDigitalOutput, "set_digital_output")

class SetStandardDigitalOutput : public DigitalOutputCommand {
 public:
  SetStandardDigitalOutput() : DigitalOutputCommand(0, 8) {}
};

UR_ROS_RTDE_EXPORT(SetStandardDigitalOutput, "set_standard_digital_output")

class SetConfigurableDigitalOutput : public DigitalOutputCommand {
 public:
  SetConfigurableDigitalOutput() : DigitalOutputCommand(first_configurable_output, 8) {}
};

UR_ROS_RTDE_EXPORT(SetConfigurableDigitalOutput, "set_configurable_digital_output")

class SetToolDigitalOutput : public DigitalOutputCommand {
 public:
  SetToolDigitalOutput() : DigitalOutputCommand(first_tool_output, 2) {}
};

UR_ROS_RTDE_EXPORT(SetToolDigitalOutput, "set_tool_digital_output")

}  // namespace ur_ros_rtde
