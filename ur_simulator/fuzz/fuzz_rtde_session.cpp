#include <array>

#include "input.hpp"
#include "rtde/session.hpp"
#include "socket_pair.hpp"

// The RTDE packages of one client, in pieces, with a control cycle after each piece.

namespace {

using namespace ur_simulator;

void run(ur_fuzz::Input input)
{
  static boost::asio::io_context io;
  static const std::array versions{PolyscopeVersion{5, 25, 1, 0}, PolyscopeVersion{5, 4, 0, 0},
                                   PolyscopeVersion{3, 15, 8, 0}};
  ControllerState state;
  EventLog log;
  rtde::ServerContext context{state, versions[input.take_option() % versions.size()], log, {}, nullptr};
  const std::size_t piece = input.take_option();
  const fuzz::SocketPair sockets(io);
  rtde::Session session(sockets.connection(), context);
  while (!input.empty() && sockets.connection()->is_open()) {
    session.receive(input.take_piece(piece));
    ++state.cycle;
    session.publish();
    sockets.drain();
  }
  session.handle_disconnect();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  run({data, size});
  return 0;
}
