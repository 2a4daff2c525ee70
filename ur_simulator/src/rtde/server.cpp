#include "rtde/server.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rtde/session.hpp"

namespace ur_simulator::rtde {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               ControllerState & state, const PolyscopeVersion & version, EventLog & log)
    : context_{state, version, log, {}, nullptr},
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

Server::~Server()
{
  // Closing a connection calls remove_session(): the members must still exist.
  listener_.close_connections("the simulator ends");
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto session = std::make_shared<Session>(connection, context_);
  sessions_.emplace(id, session);
  context_.log.info("rtde", fmt::format("client {} ({}) connected", id, connection->remote_endpoint()));
  connection->start(
      [weak = std::weak_ptr(session)](std::string_view bytes) {
        // Keeps the session alive: the received data may close its connection.
        if (const auto locked = weak.lock()) {
          locked->receive(bytes);
        }
      },
      [this, id] { remove_session(id); });
}

void Server::remove_session(std::uint64_t id)
{
  const auto session = sessions_.extract(id).mapped();
  dropped_by_closed_sessions_ += session->dropped_packages();
  session->handle_disconnect();
}

void Server::publish()
{
  // A failed write removes the session from the map: advance first and keep the session alive.
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const std::shared_ptr<Session> session = (next++)->second;
    session->publish();
  }
}

std::size_t Server::client_count(ClientRole role) const
{
  return static_cast<std::size_t>(
      std::ranges::count_if(sessions_, [role](const auto & entry) { return entry.second->role() == role; }));
}

void Server::for_each_connection(ClientRole role, const std::function<void(Connection &)> & action)
{
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const std::shared_ptr<Session> session = (next++)->second;
    if (session->role() == role) {
      action(session->connection());
    }
  }
}

std::size_t Server::set_fieldbus_enabled(bool enabled)
{
  constexpr std::uint64_t fieldbus = 0;  // the ids of connections start at 1
  constexpr unsigned lower_registers = 24;
  constexpr unsigned lower_bit_registers = 64;
  std::size_t used_by_clients = 0;
  for (const InputField & field : input_fields()) {
    const bool bit_register = field.name.starts_with("input_bit_register_");
    if (!field.name.starts_with("input_") ||
        field.index >= (bit_register ? lower_bit_registers : lower_registers)) {
      continue;
    }
    const auto [owner, added] = context_.input_owners.try_emplace(&field, fieldbus);
    used_by_clients += owner->second == fieldbus ? 0 : 1;
    if (!enabled && owner->second == fieldbus) {
      context_.input_owners.erase(owner);
    }
  }
  return used_by_clients;
}

std::uint64_t Server::dropped_packages() const
{
  std::uint64_t dropped = dropped_by_closed_sessions_;
  for (const auto & [id, session] : sessions_) {
    dropped += session->dropped_packages();
  }
  return dropped;
}

}  // namespace ur_simulator::rtde
