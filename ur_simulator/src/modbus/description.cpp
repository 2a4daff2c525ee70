#include "modbus/description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/big_endian.hpp"
#include "modbus/message.hpp"

namespace ur_simulator::modbus {
namespace {

std::string hex(std::string_view bytes)
{
  return fmt::format("{:02x}",
                     fmt::join(reinterpret_cast<const unsigned char *>(bytes.data()),
                               reinterpret_cast<const unsigned char *>(bytes.data()) + bytes.size(), " "));
}

/// nullptr: not supported.
const char * name_of(std::uint8_t function)
{
  switch (function) {
    case read_coils:
      return "read coils";
    case read_discrete_inputs:
      return "read discrete inputs";
    case read_holding_registers:
      return "read holding registers";
    case read_input_registers:
      return "read input registers";
    case write_single_coil:
      return "write coil";
    case write_single_register:
      return "write register";
    case write_multiple_coils:
      return "write coils";
    case write_multiple_registers:
      return "write registers";
    default:
      return nullptr;
  }
}

}  // namespace

std::string describe_request(std::string_view request)
{
  const std::uint8_t function = get_u8(request, 0);
  const char * name = name_of(function);
  if (name == nullptr || request.size() < short_request_size) {
    return "invalid request " + hex(request);
  }
  const unsigned address = get_u16(request, address_at);
  if (function == write_single_coil || function == write_single_register) {
    return fmt::format("{} {}: {}", name, address, hex(request.substr(quantity_at)));
  }
  const std::string_view values = request.substr(std::min(values_at, request.size()));
  return fmt::format("{} {} to {}{}{}", name, address, address + get_u16(request, quantity_at) - 1U,
                     values.empty() ? "" : ": ", hex(values));
}

std::string describe_response(std::string_view response)
{
  const unsigned function = get_u8(response, 0);
  if ((function & error_bit) != 0) {
    return fmt::format("exception {}", get_u8(response, 1));
  }
  return function <= read_input_registers ? hex(response.substr(2)) : "written";
}

}  // namespace ur_simulator::modbus
