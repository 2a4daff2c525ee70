#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "net/listener.hpp"
#include "world/robotiq_gripper.hpp"

namespace ur_simulator::urcap {

/// The socket server of Robotiq's URCap for grippers: "GET POS" returns a register, "SET POS 255 GTO 1"
/// writes registers and is acknowledged with "ack", without a line end. While the gripper has no power, the
/// values are "?". Sources: ur_rtde's RobotiqGripper, and the functions that the URCap adds to programs.
class RobotiqServer {
 public:
  RobotiqServer(boost::asio::io_context & io, const std::string & address, std::uint16_t port,
                RobotiqGripper & gripper);
  ~RobotiqServer();
  Listener & listener() { return listener_; }

 private:
  struct Client {
    std::shared_ptr<Connection> connection;
    std::string received;
  };
  void accept(const std::shared_ptr<Connection> & connection);
  void receive(Client & client, std::string_view bytes);
  std::string answer(std::string_view line);
  std::string set(std::string_view assignments);

  RobotiqGripper & gripper_;
  std::map<std::uint64_t, Client> clients_;
  Listener listener_;
};

}  // namespace ur_simulator::urcap
