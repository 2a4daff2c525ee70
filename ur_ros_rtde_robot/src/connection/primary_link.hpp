#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "connection/tcp_stream.hpp"

namespace ur_ros_rtde {

/// What the primary interface tells about programs.
struct PrimaryMessage {
  enum class Kind {
    text,             ///< of `textmsg`
    error,            ///< a script was not taken, or ended by an error
    program_started,  ///< `text` is its name
    program_stopped,  ///< likewise; also when it came to its end
  };

  Kind kind;
  std::string text;
  int line = 0;  ///< of the script as it was sent, from 1; 0: not told
};

/// Takes the byte stream of the primary interface to pieces (UR, "Client Interface": packages of a big-endian
/// int32 size of the whole and a type; robot messages are of type 20).
class PrimaryReader {
 public:
  /// False when this is no stream of packages.
  bool feed(std::span<const std::byte> bytes);
  std::optional<PrimaryMessage> next();
  /// The arm's type number, from the configuration data of the robot state; none before it has come.
  std::optional<std::int32_t> robot_type() const { return robot_type_; }

 private:
  std::vector<std::byte> buffer_;
  std::optional<std::int32_t> robot_type_;
  std::deque<PrimaryMessage> messages_;
};

/// A connection to the primary interface (port 30001): sends scripts, and hears what becomes of them.
class PrimaryLink {
 public:
  /// Returns when the controller has greeted: what happens from then on is heard.
  static Expected<PrimaryLink> connect(const std::string & address, std::chrono::milliseconds limit);

  Status send(std::string_view script, std::chrono::milliseconds limit);
  /// The next message; none, if none came within `wait`.
  Expected<std::optional<PrimaryMessage>> next(std::chrono::milliseconds wait);
  /// Waits for PrimaryReader::robot_type().
  Expected<std::int32_t> robot_type(std::chrono::milliseconds limit);

 private:
  explicit PrimaryLink(TcpStream stream) : stream_(std::move(stream)) {}
  Expected<std::size_t> read(std::chrono::milliseconds wait);

  TcpStream stream_;
  PrimaryReader reader_;
};

}  // namespace ur_ros_rtde
