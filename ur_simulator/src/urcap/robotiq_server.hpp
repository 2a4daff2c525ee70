#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "net/line_server.hpp"
#include "world/robotiq_gripper.hpp"

namespace ur_simulator::urcap {

/// The socket server of Robotiq's URCap for grippers: "GET POS" returns a register, "SET POS 255 GTO 1"
/// writes registers and is acknowledged with "ack", without a line end. While the gripper has no power, the
/// values are "?". Sources: ur_rtde's RobotiqGripper, and the functions that the URCap adds to programs.
class RobotiqServer {
 public:
  RobotiqServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                RobotiqGripper & gripper);
  Listener & listener() { return server_.listener(); }
  /// Executes a line and returns its reply.
  std::string answer(std::string_view line);

 private:
  std::string set(std::string_view assignments);

  RobotiqGripper & gripper_;
  LineServer server_;
};

}  // namespace ur_simulator::urcap
