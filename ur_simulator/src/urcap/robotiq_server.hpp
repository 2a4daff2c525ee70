#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "net/session_server.hpp"
#include "world/robotiq_gripper.hpp"

namespace ur_simulator::urcap {

/// The socket server of Robotiq's URCap for grippers. "GET PRE" with a line end returns "PRE 077" and a line
/// end; without one, as the functions of the URCap send it, the value alone. "SET POS 255 GTO 1" writes
/// registers and is acknowledged with "ack", without a line end. While the gripper has no power, its values
/// are "?". Sources: a recorded session, the functions that the URCap adds to programs, and ur_rtde's
/// RobotiqGripper.
class RobotiqServer {
 public:
  RobotiqServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                RobotiqGripper & gripper);
  Listener & listener() { return sessions_.listener(); }
  /// Executes a request with or without a line end and returns its reply.
  std::string answer(std::string_view request);

 private:
  class Session;

  /// The value of a variable as it is sent; nothing if there is none with this name.
  std::optional<std::string> value(std::string_view name) const;
  std::string set(std::string_view assignments);

  RobotiqGripper & gripper_;
  SessionServer<Session> sessions_;
};

}  // namespace ur_simulator::urcap
