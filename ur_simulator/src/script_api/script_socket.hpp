#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "urscript/library.hpp"

namespace ur_simulator {

/// A TCP connection opened by a program with socket_open(). All calls are non-blocking and run on the
/// controller's thread.
class ScriptSocket {
 public:
  virtual ~ScriptSocket() = default;
  virtual bool connected() const = 0;
  /// True if connecting failed or the peer closed the connection. Received bytes may remain.
  virtual bool failed() const = 0;
  virtual void send(std::string_view bytes) = 0;
  /// Received bytes; the reader removes what it has consumed. Called at each attempt to read: further data
  /// is received once there is room for it.
  virtual std::string & received() = 0;
};

/// Starts to connect. The socket is closed with its last reference.
using OpenSocket = std::function<std::shared_ptr<ScriptSocket>(const std::string & host, std::uint16_t port)>;

/// A copy of the library with the socket functions added.
std::shared_ptr<const urscript::Library> with_sockets(const urscript::Library & library,
                                                      OpenSocket open_socket);

}  // namespace ur_simulator
