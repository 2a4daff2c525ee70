#include "control_port/commands.hpp"
#include "control_port/server.hpp"
#include "input.hpp"
#include "simulated_robot.hpp"
#include "socket_pair.hpp"

// Requests on the control port, one JSON object per line, with some control cycles.

namespace {

using namespace ur_simulator;

constexpr int cycles = 3;

struct Target {
  control_port::ControlPortContext make_context()
  {
    return {robot.state,
            *robot.arm,
            *robot.world,
            *robot.safety,
            robot.collisions,
            *robot.pendant,
            robot.log,
            rtde,
            {{"rtde", &rtde.listener()}},
            missed_cycles,
            trace,
            [](double) {}};
  }

  void run(ur_fuzz::Input input)
  {
    robot.reset();
    rtde.listener().set_accepting(true);
    const fuzz::SocketPair sockets(io);
    server.accept(sockets.connection());
    sockets.send(input.take_piece(0));
    sockets.send("\n");
    io.restart();
    for (int i = 0; i < cycles; ++i) {
      io.poll();
      robot.cycle();
      sockets.drain();
    }
    robot.world->step(robot.state);
    sockets.connection()->close("the test ends");
    io.poll();
  }

  boost::asio::io_context io;
  fuzz::SimulatedRobot robot{"ur10e", "5.25.1"};
  rtde::Server rtde{io, "127.0.0.1", 0, robot.state, {5, 25, 1, 0}, robot.log};
  std::uint64_t missed_cycles = 0;
  CycleTrace trace;
  control_port::ControlPortContext context = make_context();
  control_port::Server server{io, "127.0.0.1", 0, [this](const nlohmann::json & request) {
                                return control_port::execute_request(context, request);
                              }};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static Target target;
  target.run({data, size});
  return 0;
}
