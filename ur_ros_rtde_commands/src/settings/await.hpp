#pragma once

#include <cmath>
#include <string>

#include "must_do.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// How long the robot's state may take to show a setting.
constexpr std::chrono::seconds setting_limit{1};

/// Switches an output by `set` and waits until digital output `number` (0-7 standard, 8-15 configurable,
/// 16-17 tool) is reported to be in `state`.
Outcome switch_output(Run & run, unsigned number, bool state,
                      const std::function<bool(ur_rtde::RTDEIOInterface &)> & set);

/// Sets an analog output by `set` and waits until it is reported to have `value`, A or V, within `tolerance`.
Outcome set_analog_output(Run & run, unsigned pin, double value, double tolerance, const char * unit,
                          const std::function<bool(ur_rtde::RTDEIOInterface &)> & set);

/// The payload that the robot reports is this one; true where it does not report it (before PolyScope 5.5).
bool payload_is(const Sample & sample, double mass, const geometry_msgs::msg::Vector3 & center_of_gravity);
/// ur_rtde's control script takes a centre of gravity of exactly zero for: as it was.
std::vector<double> center_for_ur(const geometry_msgs::msg::Vector3 & center_of_gravity);

}  // namespace ur_ros_rtde
