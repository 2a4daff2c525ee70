#include "input.hpp"
#include "memory_socket.hpp"
#include "robotiq/robotiq_client.hpp"

// What the socket server of Robotiq's URCap replies.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  ur_fuzz::Input input(data, size);
  const std::size_t piece = input.take_option();
  ur_fuzz::set_replies(input.take_piece(0), piece);
  auto client = ur_ros_rtde_gripper_commands::RobotiqClient::connect(ur_fuzz::address);
  if (client && client->set("POS 255 SPE 100")) {
    while (client->get("POS")) {
    }
  }
  return 0;
}
