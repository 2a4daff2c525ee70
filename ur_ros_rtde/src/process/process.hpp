#pragma once

#include <functional>
#include <memory>
#include <rcl_cxx/context.hpp>
#include <vector>

#include "nodes/server.hpp"

namespace ur_ros_rtde {

/// In the order of their start. Destroyed in reverse order.
using Servers = std::vector<std::unique_ptr<Server>>;
using MakeServers = std::function<Servers(const rcl_cxx::Context::SharedPtr &)>;

/// Runs servers until SIGINT or SIGTERM. Returns the exit code: 0 on success; 1 if a goal did not end; 2 for
/// an invalid argument or parameter, or if another process has a node of the same name.
int run_process(int argc, char ** argv, const MakeServers & make);

}  // namespace ur_ros_rtde
