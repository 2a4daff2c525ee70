#include <array>
#include <cstdlib>

#include "common/big_endian.hpp"
#include "input.hpp"
#include "modbus/session.hpp"

// What a MODBUS TCP client sends, in pieces, for three versions.

namespace {

using namespace ur_simulator;

/// Whether the bytes are messages with a header and a response each.
bool are_messages(std::string_view bytes)
{
  while (bytes.size() >= 9) {
    const std::size_t length = get_u16(bytes, 4);
    if (get_u16(bytes, 2) != 0 || length < 3 || length > 254 || bytes.size() < 6 + length) {
      return false;
    }
    bytes.remove_prefix(6 + length);
  }
  return bytes.empty();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static constexpr std::array versions{PolyscopeVersion{5, 25, 1, 0}, PolyscopeVersion{10, 12, 0, 0},
                                       PolyscopeVersion{3, 0, 0, 0}};
  ur_fuzz::Input input(data, size);
  ControllerState state;
  PortMap ports(state, versions[input.take_option() % versions.size()]);
  modbus::Session session(ports);
  const std::size_t piece = input.take_option();
  while (!input.empty()) {
    const modbus::Session::Reply reply = session.receive(input.take_piece(piece));
    if (!are_messages(reply.bytes)) {
      std::abort();
    }
    if (!reply.error.empty()) {
      break;
    }
  }
  return 0;
}
