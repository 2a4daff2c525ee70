#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>

#include "log/event_log.hpp"
#include "net/session_server.hpp"
#include "rtde/fields.hpp"

namespace ur_simulator::rtde {

class Session;

/// The ur_rtde interface of a client, judged by its recipes: `receive` (outputs only), `io` (inputs only) or
/// `control` (both).
enum class ClientRole : std::uint8_t { unknown, receive, io, control };

/// Called for each received data package, after its fields have been read, with these fields.
using DataPackageHandler = std::function<void(std::span<const InputField * const>)>;

/// The data that all sessions share.
struct ServerContext {
  ControllerState & state;
  PolyscopeVersion version;
  EventLog & log;
  /// Connection that uses an input field: the first whose recipe contains it, until it disconnects.
  std::unordered_map<const InputField *, std::uint64_t> input_owners;
  DataPackageHandler on_data_package;
};

/// The Real-Time Data Exchange server, protocol versions 1 and 2 (UR, "Real-Time Data Exchange (RTDE)
/// Guide").
class Server {
 public:
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         ControllerState & state, const PolyscopeVersion & version, EventLog & log);

  void set_data_package_handler(DataPackageHandler handler) { context_.on_data_package = std::move(handler); }
  /// Sends the current state to each client whose output frequency requires a package in this cycle. Does not
  /// allocate memory.
  void publish();
  Listener & listener() { return sessions_.listener(); }
  const Listener & listener() const { return sessions_.listener(); }
  std::size_t client_count(ClientRole role) const;
  void for_each_connection(ClientRole role, const std::function<void(Connection &)> & action);
  /// Reserves the input registers 0-23 and the input bit registers 0-63 for a fieldbus, or releases them.
  /// Registers of RTDE clients stay with the client; returns their number.
  std::size_t set_fieldbus_enabled(bool enabled);
  /// Number of data packages that were dropped because a client did not read.
  std::uint64_t dropped_packages() const;

 private:
  std::shared_ptr<Session> make_session(const std::shared_ptr<Connection> & connection);

  ServerContext context_;
  std::uint64_t dropped_by_closed_sessions_ = 0;
  SessionServer<Session> sessions_;
};

}  // namespace ur_simulator::rtde
