#include "rtde/server.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rtde/session.hpp"

namespace ur_simulator::rtde {

Server::Server(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
               ControllerState & state, const PolyscopeVersion & version, EventLog & log)
    : shared_{state, version, log, {}, nullptr},
      listener_(io, address, port,
                [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
{
}

Server::~Server()
{
  // The sessions' ends reach back into this object: end them while it is whole.
  listener_.close_all();
}

void Server::accept(const std::shared_ptr<Connection> & connection)
{
  const std::uint64_t id = connection->id();
  auto session = std::make_shared<Session>(connection, shared_);
  sessions_.emplace(id, session);
  shared_.log.info("rtde", fmt::format("client {} ({}) connected", id, connection->peer()));
  connection->start(
      [weak = std::weak_ptr(session)](std::string_view bytes) {
        // Held while it works: what it receives may end it.
        if (const auto alive = weak.lock()) {
          alive->receive(bytes);
        }
      },
      [this, id] { end(id); });
}

void Server::end(std::uint64_t id)
{
  const auto session = sessions_.extract(id).mapped();
  dropped_before_ += session->dropped_packages();
  session->leave();
}

void Server::publish()
{
  // A failed write ends its session, which removes it from the map: look ahead and hold it.
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const std::shared_ptr<Session> session = (next++)->second;
    session->publish();
  }
}

std::size_t Server::clients(ClientRole role) const
{
  return static_cast<std::size_t>(
      std::ranges::count_if(sessions_, [role](const auto & entry) { return entry.second->role() == role; }));
}

void Server::for_each(ClientRole role, const std::function<void(Connection &)> & action)
{
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const std::shared_ptr<Session> session = (next++)->second;
    if (session->role() == role) {
      action(session->connection());
    }
  }
}

std::size_t Server::set_fieldbus(bool on)
{
  constexpr std::uint64_t fieldbus = 0;  // connections count from 1
  constexpr unsigned lower_range = 24;
  constexpr unsigned lower_bits = 64;
  std::size_t taken_by_others = 0;
  for (const InputField & field : input_fields()) {
    const bool bit = field.name.starts_with("input_bit_register_");
    if (!field.name.starts_with("input_") || field.index >= (bit ? lower_bits : lower_range)) {
      continue;
    }
    const auto [owner, added] = shared_.owners.try_emplace(&field, fieldbus);
    taken_by_others += owner->second == fieldbus ? 0 : 1;
    if (!on && owner->second == fieldbus) {
      shared_.owners.erase(owner);
    }
  }
  return taken_by_others;
}

std::uint64_t Server::dropped_packages() const
{
  std::uint64_t dropped = dropped_before_;
  for (const auto & [id, session] : sessions_) {
    dropped += session->dropped_packages();
  }
  return dropped;
}

}  // namespace ur_simulator::rtde
