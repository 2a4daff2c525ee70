#pragma once

#include <functional>
#include <rcl_cxx/context.hpp>

#include "nodes/server.hpp"

namespace ur_ros_rtde {

using MakeServers = std::function<Servers(const rcl_cxx::Context::SharedPtr &)>;

/// Runs servers until SIGINT or SIGTERM. Returns the exit code: 0 on success; 1 if a goal did not end; 2 for
/// an invalid argument or parameter, or if another process has a node of the same name.
int run_process(int argc, char ** argv, const MakeServers & make);

}  // namespace ur_ros_rtde
