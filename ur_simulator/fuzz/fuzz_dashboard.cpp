#include "dashboard/server.hpp"
#include "input.hpp"
#include "simulated_robot.hpp"
#include "socket_pair.hpp"

// The lines that a client sends to the dashboard server of an e-Series or a CB3 robot, with some control
// cycles.

namespace {

using namespace ur_simulator;

constexpr int cycles = 3;

struct Target {
  Target(const char * model, const char * version)
      : robot(model, version), server(io, "127.0.0.1", 0, *robot.pendant)
  {
  }

  void run(ur_fuzz::Input input)
  {
    robot.reset_controller();  // there is no program that could run
    const fuzz::SocketPair sockets(io);
    server.accept(sockets.connection());
    sockets.send(input.take_piece(0));
    sockets.send("\n");
    io.restart();
    io.poll();
    for (int i = 0; i < cycles; ++i) {
      robot.cycle();
      server.cycle();
      sockets.drain();
    }
    sockets.connection()->close("the test ends");
    io.poll();
  }

  boost::asio::io_context io;
  fuzz::SimulatedRobot robot;
  dashboard::Server server;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static Target e_series("ur10e", "5.25.1");
  static Target cb3("ur5", "3.15.8");
  ur_fuzz::Input input(data, size);
  (input.take_option() % 2 == 0 ? e_series : cb3).run(input);
  return 0;
}
