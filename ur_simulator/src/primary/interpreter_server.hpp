#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <string>

#include "net/line_server.hpp"
#include "polyscope/pendant.hpp"
#include "script_api/interpreter_mode.hpp"

namespace ur_simulator::primary {

/// Port 30020: statements for the program in interpreter mode, one line each (UR, script manual, "Interpreter
/// Mode").
class InterpreterServer {
 public:
  InterpreterServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                    Pendant & pendant, InterpreterMode & mode);

  /// Call once per control cycle.
  void cycle();
  Listener & listener() { return server_.listener(); }
  const Listener & listener() const { return server_.listener(); }

 private:
  void receive(std::string_view line, const std::shared_ptr<Connection> & client);

  Pendant & pendant_;
  InterpreterMode & mode_;
  LineServer server_;
};

}  // namespace ur_simulator::primary
