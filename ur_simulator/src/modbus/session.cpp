#include "modbus/session.hpp"

#include <fmt/format.h>

#include "common/big_endian.hpp"
#include "modbus/description.hpp"
#include "modbus/message.hpp"
#include "modbus/protocol.hpp"

namespace ur_simulator::modbus {
namespace {

// The header (MODBUS Messaging on TCP/IP Implementation Guide V1.0b): transaction, protocol, length of the
// rest of the message, unit.
constexpr std::size_t protocol_at = 2;
constexpr std::size_t length_at = 4;
constexpr std::size_t unit_at = 6;
constexpr std::size_t header_size = 7;
constexpr unsigned min_length = 2;    // unit and function code
constexpr unsigned max_length = 254;  // unit and 253 bytes

constexpr unsigned modbus_protocol = 0;

}  // namespace

Session::Reply Session::receive(std::string_view bytes, const PeerLog & log)
{
  received_.append(bytes);
  Reply reply;
  std::string_view rest = received_;
  while (rest.size() >= header_size) {
    const unsigned length = get_u16(rest, length_at);
    if (length < min_length || length > max_length) {
      reply.error = fmt::format("the length of a MODBUS message is {}: it must be {} to {}", length,
                                min_length, max_length);
      break;
    }
    const std::size_t size = unit_at + length;
    if (rest.size() < size) {
      break;
    }
    answer(rest.substr(0, size), reply.bytes, log);
    rest.remove_prefix(size);
  }
  received_.erase(0, received_.size() - rest.size());
  return reply;
}

void Session::answer(std::string_view message, std::string & responses, const PeerLog & log)
{
  const unsigned protocol = get_u16(message, protocol_at);
  if (protocol != modbus_protocol) {
    log.note("discarded: protocol {} is not MODBUS (0)", protocol);
    return;
  }
  const std::string_view request = message.substr(header_size);
  const std::string response = execute(ports_, request);
  if (log) {
    log.from_peer("{}", describe_request(request));
    log.to_peer("{}", describe_response(response));
  }
  responses += message.substr(0, length_at);
  put_u16(responses, static_cast<std::uint16_t>(1 + response.size()));
  responses += message[unit_at];
  responses += response;
}

}  // namespace ur_simulator::modbus
