#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "net/listener.hpp"

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
  ~LineServer();
  LineServer(const LineServer &) = delete;
  LineServer & operator=(const LineServer &) = delete;

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

  const LineLimit limit_;
  const Answer answer_;
  std::map<std::uint64_t, std::shared_ptr<Client>> clients_;
  Listener listener_;
};

}  // namespace ur_simulator
