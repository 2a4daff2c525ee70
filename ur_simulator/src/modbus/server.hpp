#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <string>

#include "net/session_server.hpp"
#include "port_map/port_map.hpp"

namespace ur_simulator::modbus {

/// The MODBUS TCP server of the controller (UR, "Modbus Server - 16377").
class Server {
 public:
  /// Throws as Listener does.
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         ControllerState & state, const PolyscopeVersion & version);

  Listener & listener() { return clients_.listener(); }
  const Listener & listener() const { return clients_.listener(); }

 private:
  class Client;

  PortMap ports_;
  SessionServer<Client> clients_;
};

}  // namespace ur_simulator::modbus
