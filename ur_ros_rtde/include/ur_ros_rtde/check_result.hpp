#pragma once

#include <fmt/format.h>

#include <string_view>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Throws RobotError (rejected_by_robot) if `succeeded`, the return value of a ur_rtde function, is false.
/// `action` completes the message: "the control program on the robot did not <action>".
inline void check_result(bool succeeded, std::string_view action)
{
  if (!succeeded) {
    throw RobotError({ErrorCode::rejected_by_robot,
                      fmt::format("the control program on the robot did not {}: see the log on the teach "
                                  "pendant",
                                  action)});
  }
}

}  // namespace ur_ros_rtde
