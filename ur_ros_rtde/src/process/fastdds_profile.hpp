#pragma once

#include <rcl_cxx/logging.hpp>

namespace ur_ros_rtde {

/// Makes Fast DDS use the profile of this package for nodes (docs/internals/discovery.md) unless the user has
/// chosen a profile. Call it before the first context is created. Other middlewares are not affected.
void use_fastdds_profile();

/// Logs a message if the profile of the user leaves type propagation enabled.
void report_fastdds_profile(const rcl_cxx::Logger & logger);

}  // namespace ur_ros_rtde
