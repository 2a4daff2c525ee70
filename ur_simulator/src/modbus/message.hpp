#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// The form of MODBUS messages (MODBUS Application Protocol Specification V1.1b3).

namespace ur_simulator::modbus {

enum FunctionCode : std::uint8_t {
  read_coils = 1,
  read_discrete_inputs = 2,
  read_holding_registers = 3,
  read_input_registers = 4,
  write_single_coil = 5,
  write_single_register = 6,
  write_multiple_coils = 15,
  write_multiple_registers = 16,
};

constexpr unsigned error_bit = 0x80;  ///< of the function code: the response is an exception

// Fields of a request, after the function code: address, and quantity or value. Requests that write several
// values go on with the number of bytes and the values.
constexpr std::size_t address_at = 1;
constexpr std::size_t quantity_at = 3;
constexpr std::size_t short_request_size = 5;
constexpr std::size_t byte_count_at = 5;
constexpr std::size_t values_at = 6;

// Bytes and big-endian words. Those that are read must exist.

inline std::uint8_t get_u8(std::string_view bytes, std::size_t at)
{
  return static_cast<std::uint8_t>(bytes[at]);
}

inline std::uint16_t get_u16(std::string_view bytes, std::size_t at)
{
  return static_cast<std::uint16_t>(get_u8(bytes, at) << 8 | get_u8(bytes, at + 1));
}

inline void put_u8(std::string & to, unsigned value)
{
  to += static_cast<char>(static_cast<std::uint8_t>(value));
}

inline void put_u16(std::string & to, unsigned value)
{
  put_u8(to, value >> 8);
  put_u8(to, value);
}

}  // namespace ur_simulator::modbus
