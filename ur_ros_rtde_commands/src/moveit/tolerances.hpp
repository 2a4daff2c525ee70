#pragma once

#include <array>
#include <control_msgs/msg/joint_tolerance.hpp>
#include <string>
#include <vector>

#include "streaming/servo_stream.hpp"

namespace ur_ros_rtde {

/// What a joint may be away from its trajectory, in UR's order. Infinity: as far as it likes.
struct Tolerances {
  trajectory::Joints position, velocity;

  /// By ros2_control's convention: 0 is the default, below 0 is no limit. Refused: a name that `names` does
  /// not have, a number that is not finite, an acceleration, which the controller does not measure.
  static Expected<Tolerances> read(std::string_view field,
                                   const std::vector<control_msgs::msg::JointTolerance> & list,
                                   const std::vector<std::string> & names, double default_position);

  /// Which joint is too far off, and by what.
  Status hold(const trajectory::Joints & position_error, const trajectory::Joints & velocity_error) const;
};

}  // namespace ur_ros_rtde
