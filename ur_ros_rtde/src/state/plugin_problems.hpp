#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>

#include "plugins/plugin_index.hpp"

namespace ur_ros_rtde {

/// Logs problems of plugins as errors of the node; not while it is shut down, when everything fails. Nodes of
/// one process look at the same plugins and may be given the same parameters: each problem is logged once.
ReportProblem log_plugin_problems(std::shared_ptr<rcl_cxx::Node> node);

}  // namespace ur_ros_rtde
