#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "net/session_server.hpp"

namespace ur_simulator {

/// A server whose clients send lines, each of which is answered at once or later.
class LineServer {
 public:
  /// Returns the reply to a line, with its line end if it has one; empty: none, or a later one that the
  /// function sends itself.
  using Answer =
      std::function<std::string(std::string_view line, const std::shared_ptr<Connection> & client)>;
  struct LineLimit {
    std::size_t size;        ///< bytes; the connection of a client that sends a longer line is closed
    std::string reply = "";  ///< sent before that
  };

  LineServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port, LineLimit limit,
             Answer answer);

  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection);
  Listener & listener() { return sessions_.listener(); }
  const Listener & listener() const { return sessions_.listener(); }

 private:
  class Session;

  const LineLimit limit_;
  const Answer answer_;
  SessionServer<Session> sessions_;
};

}  // namespace ur_simulator
