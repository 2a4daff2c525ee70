#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace ur_ros_rtde_gripper_commands {

constexpr std::uint16_t robotiq_port = 63352;

/// A connection to the socket server of Robotiq's URCap, which gives access to the registers of the gripper.
/// ur_rtde's RobotiqGripper is not used: its waits have no time limit and cannot be canceled.
class RobotiqClient {
 public:
  /// not_supported if the port does not answer: the URCap is not installed.
  static ur_ros_rtde::Expected<RobotiqClient> connect(const std::string & address,
                                                      std::uint16_t port = robotiq_port);

  /// Reads a register: "GET POS". not_ready while the URCap cannot read the gripper; link_lost.
  ur_ros_rtde::Expected<int> get(std::string_view name);
  /// Writes registers: "POS 255 SPE 100". rejected_by_robot if the URCap does not acknowledge it; link_lost.
  ur_ros_rtde::Status set(std::string_view assignments);

 private:
  explicit RobotiqClient(ur_ros_rtde::TcpSocket socket) : socket_(std::move(socket)) {}
  ur_ros_rtde::Expected<std::string> request(const std::string & line);

  ur_ros_rtde::TcpSocket socket_;
};

}  // namespace ur_ros_rtde_gripper_commands
