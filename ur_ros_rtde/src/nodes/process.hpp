#pragma once

#include <functional>
#include <memory>
#include <rcl_cxx/context.hpp>
#include <vector>

#include "nodes/server.hpp"

namespace ur_ros_rtde {

/// In the order in which they are started; destroyed in the opposite one.
using Servers = std::vector<std::unique_ptr<Server>>;
using MakeServers = std::function<Servers(const rcl_cxx::Context::SharedPtr &)>;

/// The main function of a node's program: until SIGINT or SIGTERM. Returns the exit code: 0; 1 if something
/// could not be ended; 2 for a wrong argument or parameter, or a node whose name another process has.
int run_process(int argc, char ** argv, const MakeServers & make);

}  // namespace ur_ros_rtde
