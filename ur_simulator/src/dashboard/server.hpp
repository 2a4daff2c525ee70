#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "polyscope/pendant.hpp"

namespace ur_simulator::dashboard {

/// The Dashboard Server: one line a command, one line a reply.
class Server {
 public:
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port, Pendant & pendant);
  ~Server();
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  /// Sends the answers that were still to come; once a control cycle.
  void cycle();

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    std::string received;
    /// Control mode when it connected: an e-Series keeps to it until the client reconnects.
    bool remote_when_connected;
    /// The answer it waits for; what it sends meanwhile is answered after it.
    ReportWriter::Pending pending = nullptr;
  };
  void accept(const std::shared_ptr<Connection> & connection);
  void receive(Client & client, std::string_view bytes);
  void answer(Client & client, std::string_view line);
  /// Sends the answer that the client waits for, if there is one by now.
  void deliver(Client & client);

  Pendant & pendant_;
  std::map<std::uint64_t, Client> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::dashboard
