#include "rtde/server.hpp"

#include <fmt/format.h>

#include "rtde/session.hpp"

namespace ur_simulator::rtde {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               ControllerState & state, const PolyscopeVersion & version, EventLog & log)
    : context_{state, version, log, {}, nullptr},
      sessions_(
          io, address, port,
          [this](const std::shared_ptr<Connection> & connection) { return make_session(connection); },
          [this](Session & session) {
            dropped_by_closed_sessions_ += session.dropped_packages();
            session.handle_disconnect();
          })
{
}

std::shared_ptr<Session> Server::make_session(const std::shared_ptr<Connection> & connection)
{
  context_.log.info("rtde",
                    fmt::format("client {} ({}) connected", connection->id(), connection->remote_endpoint()));
  return std::make_shared<Session>(connection, context_);
}

void Server::publish()
{
  sessions_.for_each([](Session & session) { session.publish(); });
}

std::size_t Server::client_count(ClientRole role) const
{
  std::size_t count = 0;
  sessions_.for_each([&](const Session & session) { count += session.role() == role ? 1 : 0; });
  return count;
}

void Server::for_each_connection(ClientRole role, const std::function<void(Connection &)> & action)
{
  sessions_.for_each([&](Session & session) {
    if (session.role() == role) {
      action(session.connection());
    }
  });
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
  sessions_.for_each([&](const Session & session) { dropped += session.dropped_packages(); });
  return dropped;
}

}  // namespace ur_simulator::rtde
