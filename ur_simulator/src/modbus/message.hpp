#pragma once

#include <cstddef>
#include <cstdint>

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

}  // namespace ur_simulator::modbus
