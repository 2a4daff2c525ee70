#pragma once

#include <string>
#include <string_view>

#include "client_log/client_log.hpp"
#include "port_map/port_map.hpp"

namespace ur_simulator::modbus {

/// The requests of one client: splits its data into messages and executes them.
class Session {
 public:
  struct Reply {
    std::string bytes;       ///< to send
    std::string error = {};  ///< not empty: why the connection must be closed, because messages have no ends
  };

  explicit Session(PortMap & ports) : ports_(ports) {}
  /// Executes the requests that are complete with these bytes. Messages of other protocols are discarded.
  Reply receive(std::string_view bytes, const PeerLog & log = {});

 private:
  /// Appends the response to a message with header.
  void answer(std::string_view message, std::string & responses, const PeerLog & log);

  PortMap & ports_;
  std::string received_;
};

}  // namespace ur_simulator::modbus
