#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "net/listener.hpp"

namespace ur_simulator {

/// A listening TCP port with a session for each connection. `void Session::receive(std::string_view)` gets
/// the data of the connection in pieces of any size. The session ends with its connection; if it closes the
/// connection itself, it is destroyed after the call in which it does so.
template <typename Session>
class SessionServer {
 public:
  using MakeSession = std::function<std::shared_ptr<Session>(const std::shared_ptr<Connection> &)>;
  /// Called with each session whose connection has been closed.
  using EndHandler = std::function<void(Session &)>;

  /// Throws as the constructor of Listener. `make_session` and `on_end` may be called until the server is
  /// destroyed: an owner declares the server after everything that they use.
  SessionServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                MakeSession make_session, EndHandler on_end = nullptr)
      : make_session_(std::move(make_session)),
        on_end_(std::move(on_end)),
        listener_(io, address, port,
                  [this](const std::shared_ptr<Connection> & connection) { accept(connection); })
  {
  }
  ~SessionServer() { listener_.close_connections("the simulator ends"); }
  SessionServer(const SessionServer &) = delete;
  SessionServer & operator=(const SessionServer &) = delete;

  /// Serves a connection, as each that the listener accepts.
  void accept(const std::shared_ptr<Connection> & connection)
  {
    const std::uint64_t id = connection->id();
    const std::shared_ptr<Session> session = make_session_(connection);
    sessions_.emplace(id, session);
    connection->start(
        [weak = std::weak_ptr(session)](std::string_view bytes) {
          if (const auto locked = weak.lock()) {  // keeps the session while it receives
            locked->receive(bytes);
          }
        },
        [this, id] { end(id); });
  }

  /// Calls `action` with each session. It may end the session. Does not allocate memory.
  template <typename Action>
  void for_each(const Action & action)
  {
    for (auto next = sessions_.begin(); next != sessions_.end();) {
      const std::shared_ptr<Session> session = (next++)->second;
      action(*session);
    }
  }
  template <typename Action>
  void for_each(const Action & action) const
  {
    for (const auto & [id, session] : sessions_) {
      action(std::as_const(*session));
    }
  }

  bool empty() const { return sessions_.empty(); }
  Listener & listener() { return listener_; }
  const Listener & listener() const { return listener_; }

 private:
  void end(std::uint64_t id)
  {
    const std::shared_ptr<Session> session = sessions_.extract(id).mapped();
    if (on_end_) {
      on_end_(*session);
    }
  }

  MakeSession make_session_;
  EndHandler on_end_;
  std::map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  Listener listener_;
};

}  // namespace ur_simulator
