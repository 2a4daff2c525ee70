#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "script_api/script_socket.hpp"

namespace ur_simulator::script_api {

/// The open sockets of all running programs. A program knows its sockets by name.
class ProgramSockets {
 public:
  explicit ProgramSockets(OpenSocket open) : open_(std::move(open)) {}

  static constexpr std::size_t limit = 100;  ///< of all programs

  /// Starts to connect. A socket of the same name is closed. nullptr if `limit` sockets are open.
  std::shared_ptr<ScriptSocket> open(std::uint64_t program, const std::string & name,
                                     const std::string & address, std::uint16_t port);
  /// nullptr if the program has no open socket of this name.
  std::shared_ptr<ScriptSocket> find(std::uint64_t program, const std::string & name) const;
  void close(std::uint64_t program, const std::string & name);
  void close_all(std::uint64_t program);

 private:
  OpenSocket open_;
  std::map<std::pair<std::uint64_t, std::string>, std::shared_ptr<ScriptSocket>> sockets_;
};

using ProgramSocketsPtr = std::shared_ptr<ProgramSockets>;

}  // namespace ur_simulator::script_api
