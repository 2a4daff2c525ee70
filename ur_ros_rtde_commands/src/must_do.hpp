#pragma once

#include <fmt/format.h>

#include <string_view>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Throws RobotError (rejected_by_robot) when ur_rtde says that a command was not carried out.
inline void must_do(bool done, std::string_view what)
{
  if (!done) {
    throw RobotError({ErrorCode::rejected_by_robot,
                      fmt::format("the control program on the robot did not {}: the log on the teach pendant "
                                  "may say why",
                                  what)});
  }
}

}  // namespace ur_ros_rtde
