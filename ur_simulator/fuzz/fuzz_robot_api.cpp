#include "input.hpp"
#include "robot_api/server.hpp"
#include "simulated_robot.hpp"
#include "socket_pair.hpp"

// What an HTTP client sends to the Robot API of PolyScope X in one or two pieces. One request is executed per
// control cycle.

namespace {

using namespace ur_simulator;

constexpr int cycles = 12;

struct Target {
  void run(ur_fuzz::Input input)
  {
    robot.reset();
    robot.pendant->set_remote_control(input.take_option() % 4 != 0);
    const std::size_t first_piece = input.take_option();
    const fuzz::SocketPair sockets(io);
    server.accept(sockets.connection());
    io.restart();
    for (int i = 0; i < cycles; ++i) {
      if (!input.empty()) {
        sockets.send(input.take_piece(i == 0 ? first_piece : 0));
      }
      io.poll();
      robot.cycle();
      server.cycle();
      sockets.drain();
    }
    sockets.connection()->close("the test ends");
    io.poll();
  }

  boost::asio::io_context io;
  fuzz::SimulatedRobot robot{"ur10e", "10.14.0"};
  robot_api::Server server{io, "127.0.0.1", 0, *robot.pendant};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static Target target;
  target.run({data, size});
  return 0;
}
