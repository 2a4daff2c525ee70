#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "net/line_server.hpp"

namespace ur_simulator::control_port {

/// JSON over TCP: one request per line, one reply per line, in order.
class Server {
 public:
  using RequestHandler = std::function<nlohmann::json(const nlohmann::json & request)>;

  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         RequestHandler handle_request);
  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection) { server_.accept(connection); }
  Listener & listener() { return server_.listener(); }
  const Listener & listener() const { return server_.listener(); }
  /// The reply to a line, with its line end. Empty for an empty line.
  std::string reply_to(std::string_view line) const;

 private:
  RequestHandler handle_request_;
  LineServer server_;
};

}  // namespace ur_simulator::control_port
