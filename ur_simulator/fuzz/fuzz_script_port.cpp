#include "input.hpp"
#include "primary/client_interface_server.hpp"
#include "primary/messages.hpp"
#include "simulated_robot.hpp"
#include "socket_pair.hpp"

// Scripts and controller commands as a client sends them to the primary interface, and the messages about
// them.

namespace {

using namespace ur_simulator;

constexpr int cycles = 5;

struct Target {
  void run(ur_fuzz::Input input)
  {
    robot.reset();
    robot.log.add_listener(
        [this](const LogEntry & entry) { server.broadcast(primary::robot_message_for(entry)); });
    const std::size_t piece = input.take_option();
    const fuzz::SocketPair sockets(io);
    server.accept(sockets.connection());
    io.restart();
    while (!input.empty()) {
      sockets.send(input.take_piece(piece));
      io.poll();
    }
    for (int i = 0; i < cycles; ++i) {
      robot.cycle();
      sockets.drain();
    }
    sockets.connection()->close("the test ends");
    io.poll();
  }

  boost::asio::io_context io;
  fuzz::SimulatedRobot robot{"ur10e", "5.25.1"};
  primary::ClientInterfaceServer server{
      io, "127.0.0.1", 0, *robot.pendant, nullptr, primary::ScriptAccess::full};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static Target target;
  target.run({data, size});
  return 0;
}
