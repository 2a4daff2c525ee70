#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>

#include "plugins/plugin_index.hpp"

namespace ur_ros_rtde {

/// Logs problems of plugins as errors of the node, except during shutdown. The nodes of one process load the
/// same plugin descriptions and may have the same parameters, so each problem is logged once per process.
ReportProblem log_plugin_problems(std::shared_ptr<rcl_cxx::Node> node);

}  // namespace ur_ros_rtde
