#pragma once

#include "script_api/program_sockets.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

/// Adds socket_read_… and socket_get_var.
void add_socket_read_builtins(Library & library, const ProgramSocketsPtr & sockets);

}  // namespace ur_simulator::script_api
