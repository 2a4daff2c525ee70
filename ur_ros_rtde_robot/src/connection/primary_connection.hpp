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

#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde {

/// A message of the primary interface about programs.
struct PrimaryMessage {
  enum class Kind {
    text,             ///< from `textmsg`
    error,            ///< a script was rejected or aborted
    error_code,       ///< a violation or fault stopped the robot: "C4A65: …"
    program_started,  ///< `text` is its name
    program_stopped,  ///< likewise, also after a regular end
  };

  Kind kind;
  std::string text;
  int line = 0;  ///< line of the script as sent, from 1; 0: unknown
};

/// What the robot state says about the arm.
struct ArmData {
  std::int32_t type = 0;                      ///< type number, from the configuration data
  std::optional<kinematics::DhRows> dh_rows;  ///< calibration, from the kinematics data
};

/// Parses the byte stream of the primary interface (UR, "Client Interface"): packages with a big-endian int32
/// total size and a type, of which 20 is a robot message.
class PrimaryReader {
 public:
  /// False if the bytes are not a stream of packages.
  bool feed(std::span<const std::byte> bytes);
  std::optional<PrimaryMessage> next();
  /// The newest robot state that contains the type of the arm; none before its arrival.
  const std::optional<ArmData> & arm_data() const { return arm_data_; }

 private:
  std::vector<std::byte> buffer_;
  std::optional<ArmData> arm_data_;
  std::deque<PrimaryMessage> messages_;
};

/// A connection to the primary interface (port 30001), which executes scripts and reports about them.
class PrimaryConnection {
 public:
  /// Returns after the first data from the controller, so that all later messages are received.
  static Expected<PrimaryConnection> connect(const std::string & address, std::chrono::milliseconds timeout);

  Status send(std::string_view script, std::chrono::milliseconds timeout);
  /// Nothing can be sent afterwards. Does not wait; may be called by another thread.
  void shut_down_sending() const { socket_.shut_down_writing(); }
  /// The next message; none if none arrives within `wait`.
  Expected<std::optional<PrimaryMessage>> next(std::chrono::milliseconds wait);
  /// Waits for PrimaryReader::arm_data().
  Expected<ArmData> arm_data(std::chrono::milliseconds timeout);

 private:
  explicit PrimaryConnection(TcpSocket socket) : socket_(std::move(socket)) {}
  Expected<std::size_t> read(std::chrono::milliseconds wait);

  TcpSocket socket_;
  PrimaryReader reader_;
};

}  // namespace ur_ros_rtde
