#include "control_port/commands.hpp"
#include "control_port/reply.hpp"
#include "control_port/server.hpp"
#include "input.hpp"

// One request on the control port: JSON, the fields of the command, the reply to an error. Nothing is
// executed: that is the target `control_port`.

namespace {

using namespace ur_simulator;
using nlohmann::json;

json check_request(const json & request)
{
  (void)control_port::prepare_request(request);
  return {{"ok", true}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static boost::asio::io_context io;
  static const control_port::Server server(io, "127.0.0.1", 0, check_request);
  (void)server.reply_to(ur_fuzz::Input(data, size).take_piece(0));
  return 0;
}
