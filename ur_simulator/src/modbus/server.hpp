#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "modbus/session.hpp"
#include "net/listener.hpp"
#include "port_map/port_map.hpp"

namespace ur_simulator::modbus {

/// The MODBUS TCP server of the controller (UR, "Modbus Server - 16377").
class Server {
 public:
  /// Throws as Listener does.
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         ControllerState & state, const PolyscopeVersion & version);
  ~Server();
  Server(const Server &) = delete;
  Server & operator=(const Server &) = delete;

  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    Session session;
  };

  void accept(const std::shared_ptr<Connection> & connection);

  PortMap ports_;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::modbus
