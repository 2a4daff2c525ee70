#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "connection/primary_link.hpp"

namespace ur_ros_rtde {

/// Lets the controller compile the definitions of a control script (its text without a `def` around it),
/// running nothing: the error it finds, its line counted in `text`; none if it takes them. The program that
/// ran before must have been stopped.
Expected<std::optional<PrimaryMessage>> check_definitions(const std::string & address,
                                                          const std::string & text,
                                                          std::chrono::milliseconds limit);

}  // namespace ur_ros_rtde
