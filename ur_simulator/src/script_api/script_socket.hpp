#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "urscript/library.hpp"

namespace ur_simulator {

/// A TCP client of a program (socket_open()). Nothing waits; everything happens on the controller's thread.
class ScriptSocket {
 public:
  virtual ~ScriptSocket() = default;
  virtual bool connected() const = 0;
  /// Could not connect, or the peer has gone. What it sent before may still be there.
  virtual bool failed() const = 0;
  virtual void send(std::string_view bytes) = 0;
  /// What came and was not taken yet.
  virtual std::string & received() = 0;
};

/// Begins to connect. The socket closes when the last reference goes.
using OpenSocket = std::function<std::shared_ptr<ScriptSocket>(const std::string & host, std::uint16_t port)>;

/// The library, with socket_open() and all that goes with it.
std::shared_ptr<const urscript::Library> with_sockets(const urscript::Library & library,
                                                      OpenSocket open_socket);

}  // namespace ur_simulator
