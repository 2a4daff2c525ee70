#pragma once

#include <array>
#include <control_msgs/msg/joint_tolerance.hpp>
#include <string>
#include <vector>

#include "streaming/servo_stream.hpp"

namespace ur_ros_rtde {

/// The permitted deviation of each joint from its trajectory, in the joint order of UR. Infinity: no limit.
struct Tolerances {
  trajectory::Joints position, velocity;

  /// Follows the convention of ros2_control: 0 is the default, a negative value is no limit. Fails for a name
  /// that is not in `names`, a value that is not finite, and an acceleration, which the robot does not
  /// measure.
  static Expected<Tolerances> read(std::string_view field,
                                   const std::vector<control_msgs::msg::JointTolerance> & list,
                                   const std::vector<std::string> & names, double default_position);

  /// Fails with the name and the deviation of the first joint that exceeds its tolerance.
  Status check(const trajectory::Joints & position_error, const trajectory::Joints & velocity_error) const;
};

}  // namespace ur_ros_rtde
