#pragma once

#include <rcl_cxx/logging.hpp>

namespace ur_ros_rtde {

/// Makes Fast DDS use the profile of this package (docs/discovery.md), unless the user has chosen another
/// one. Call it before the first context is created. Other middlewares ignore it.
void use_fastdds_profile();

/// Logs that the user's profile leaves type propagation on, if it does.
void report_fastdds_profile(const rcl_cxx::Logger & logger);

}  // namespace ur_ros_rtde
