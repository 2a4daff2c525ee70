#include <string>

#include "input.hpp"
#include "urcap/robotiq_server.hpp"

// Requests, with and without line ends, for the socket server of Robotiq's URCap.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  using namespace ur_simulator;
  static boost::asio::io_context io;
  static RobotiqGripper gripper;
  static urcap::RobotiqServer server(io, "127.0.0.1", 0, gripper);
  gripper = RobotiqGripper();
  ur_fuzz::Input input(data, size);
  gripper.step(0.002, input.take_option() % 2 == 0);
  while (!input.empty()) {
    const std::string request(input.take_line());
    (void)server.answer(request);
    (void)server.answer(request + "\n");
  }
  return 0;
}
