#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>

#include "log/event_log.hpp"
#include "net/listener.hpp"
#include "rtde/fields.hpp"

namespace ur_simulator::rtde {

class Session;

/// What a client uses the link for, as its recipes tell: ur_rtde's interfaces are `receive` (outputs only),
/// `io` (inputs only) and `control` (both).
enum class ClientRole : std::uint8_t { undecided, receive, io, control };

/// Called for each data package when its fields have been read, with those that were in it.
using PackageFunction = std::function<void(std::span<const InputField * const>)>;

/// What the sessions share. An input field belongs to the client that first asked for it, until that client
/// leaves.
struct Shared {
  ControllerState & state;
  PolyscopeVersion version;
  EventLog & log;
  std::unordered_map<const InputField *, std::uint64_t> owners;
  PackageFunction package_read;
};

/// The Real-Time Data Exchange server, protocol versions 1 and 2.
class Server {
 public:
  Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
         ControllerState & state, const PolyscopeVersion & version, EventLog & log);
  ~Server();

  void on_package(PackageFunction read) { shared_.package_read = std::move(read); }
  /// Sends the state of this cycle to every started client whose turn it is. Allocates nothing.
  void publish();
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }
  std::size_t clients() const { return sessions_.size(); }
  std::size_t clients(ClientRole role) const;
  void for_each(ClientRole role, const std::function<void(Connection &)> & action);
  /// A fieldbus of the installation has the input registers of the lower range, or gives them back. How many
  /// it has not got because an RTDE client has them.
  std::size_t set_fieldbus(bool on);
  /// Data packages that were dropped because a client did not read.
  std::uint64_t dropped_packages() const;

 private:
  void accept(const std::shared_ptr<Connection> & connection);
  void end(std::uint64_t id);

  Shared shared_;
  std::map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  std::uint64_t dropped_before_ = 0;  ///< by clients that have left
  Listener listener_;
};

}  // namespace ur_simulator::rtde
