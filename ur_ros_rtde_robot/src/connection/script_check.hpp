#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "connection/primary_connection.hpp"

namespace ur_ros_rtde {

/// Lets the controller compile the definitions of a control script (its text without an enclosing `def`)
/// without running them. Returns the compile error, with its line in `text`; none if there is no error. The
/// current program must have been stopped before.
Expected<std::optional<PrimaryMessage>> check_definitions(const std::string & address,
                                                          const std::string & text,
                                                          std::chrono::milliseconds timeout);

}  // namespace ur_ros_rtde
