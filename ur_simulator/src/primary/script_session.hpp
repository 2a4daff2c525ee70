#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "net/connection.hpp"
#include "polyscope/pendant.hpp"
#include "urscript/script_reader.hpp"

namespace ur_simulator::primary {

/// Whether a client interface runs scripts.
enum class ScriptAccess : std::uint8_t { full, read_only };

/// The connection of a client of a client interface: runs the scripts that it sends.
class ScriptSession {
 public:
  ScriptSession(std::shared_ptr<Connection> connection, Pendant & pendant, ScriptAccess access);

  void receive(std::string_view bytes);
  Connection & connection() { return *connection_; }

 private:
  Pendant::Result run(std::string_view script);
  void log_dropped_scripts();

  std::shared_ptr<Connection> connection_;
  Pendant & pendant_;
  ScriptAccess access_;
  urscript::ScriptReader reader_;
  std::uint64_t dropped_scripts_ = 0;
};

}  // namespace ur_simulator::primary
