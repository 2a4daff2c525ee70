#pragma once

#include "process/process.hpp"

namespace ur_ros_rtde {

/// Checks the names of the parameters on the command line and in parameter files, after all nodes and plugins
/// have declared theirs. A name that resembles a declared one is a typing error: throws
/// rcl_cxx::ParameterError. Any other unknown name, which may belong to a node of another process, is a
/// warning.
void check_parameter_names(const Servers & servers);

}  // namespace ur_ros_rtde
