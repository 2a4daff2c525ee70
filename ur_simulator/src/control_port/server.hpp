#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "net/listener.hpp"

namespace ur_simulator::control_port {

/// JSON over TCP: one request per line, one reply per line, in order.
class Server {
 public:
  using RequestHandler = std::function<nlohmann::json(const nlohmann::json & request)>;

  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         RequestHandler handle_request);
  ~Server();
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection);
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    std::string received;
  };
  void receive(Client & client, std::string_view bytes);
  std::string reply_to(std::string_view line) const;

  RequestHandler handle_request_;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::control_port
