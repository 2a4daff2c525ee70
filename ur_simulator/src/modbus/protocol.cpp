#include "modbus/protocol.hpp"

#include <optional>
#include <vector>

#include "common/big_endian.hpp"
#include "modbus/message.hpp"

namespace ur_simulator::modbus {
namespace {

/// Exception codes that UR documents.
enum class Exception : std::uint8_t {
  illegal_function = 1,
  illegal_data_address = 2,
  illegal_data_value = 3
};

constexpr std::uint16_t coil_on = 0xff00;
constexpr std::uint16_t coil_off = 0x0000;

std::string exception_response(std::string_view request, Exception exception)
{
  std::string response;
  put_u8(response, static_cast<std::uint8_t>(get_u8(request, 0) | error_bit));
  put_u8(response, static_cast<std::uint8_t>(exception));
  return response;
}

/// Address and quantity of a request, if it has them and the quantity is in [1, limit].
struct Span {
  unsigned address;
  unsigned quantity;
};

std::optional<Span> read_span(std::string_view request, unsigned limit)
{
  if (request.size() < short_request_size) {
    return std::nullopt;
  }
  const Span span{get_u16(request, address_at), get_u16(request, quantity_at)};
  return span.quantity >= 1 && span.quantity <= limit ? std::optional(span) : std::nullopt;
}

std::string read_bits(PortMap & ports, std::string_view request)
{
  constexpr unsigned limit = 2000;
  const auto span = read_span(request, limit);
  if (!span || request.size() != short_request_size) {
    return exception_response(request, Exception::illegal_data_value);
  }
  std::string bytes((span->quantity + 7) / 8, '\0');
  for (unsigned i = 0; i < span->quantity; ++i) {
    const auto bit = ports.read_bit(span->address + i);
    if (!bit) {
      return exception_response(request, Exception::illegal_data_address);
    }
    bytes[i / 8] = static_cast<char>(bytes[i / 8] | *bit << i % 8);
  }
  std::string response(request.substr(0, 1));
  put_u8(response, static_cast<std::uint8_t>(bytes.size()));
  return response + bytes;
}

std::string read_registers(PortMap & ports, std::string_view request)
{
  constexpr unsigned limit = 125;
  const auto span = read_span(request, limit);
  if (!span || request.size() != short_request_size) {
    return exception_response(request, Exception::illegal_data_value);
  }
  std::string response(request.substr(0, 1));
  put_u8(response, static_cast<std::uint8_t>(2 * span->quantity));
  for (unsigned i = 0; i < span->quantity; ++i) {
    const auto word = ports.read_register(span->address + i);
    if (!word) {
      return exception_response(request, Exception::illegal_data_address);
    }
    put_u16(response, *word);
  }
  return response;
}

/// Access to the bits or registers when they are written.
template <typename Value>
struct Writer {
  PortWrite (PortMap::*check)(unsigned address, Value value) const;
  void (PortMap::*write)(unsigned address, Value value);
};

constexpr Writer<bool> bit_writer{&PortMap::check_bit, &PortMap::write_bit};
constexpr Writer<std::uint16_t> register_writer{&PortMap::check_register, &PortMap::write_register};

/// The response repeats function code, address, and value or quantity.
template <typename Value>
std::string write_values(PortMap & ports, std::string_view request, const Writer<Value> & writer,
                         const std::vector<Value> & values)
{
  const unsigned address = get_u16(request, address_at);
  for (unsigned i = 0; i < values.size(); ++i) {
    switch ((ports.*writer.check)(address + i, values[i])) {
      case PortWrite::possible:
        break;
      case PortWrite::illegal_address:
        return exception_response(request, Exception::illegal_data_address);
      case PortWrite::illegal_value:
        return exception_response(request, Exception::illegal_data_value);
    }
  }
  for (unsigned i = 0; i < values.size(); ++i) {
    (ports.*writer.write)(address + i, values[i]);
  }
  return std::string(request.substr(0, short_request_size));
}

std::string write_bit(PortMap & ports, std::string_view request)
{
  const std::uint16_t value = request.size() == short_request_size ? get_u16(request, quantity_at) : 1;
  return value == coil_on || value == coil_off ? write_values(ports, request, bit_writer, {value == coil_on})
                                               : exception_response(request, Exception::illegal_data_value);
}

std::string write_register(PortMap & ports, std::string_view request)
{
  return request.size() == short_request_size
             ? write_values(ports, request, register_writer, {get_u16(request, quantity_at)})
             : exception_response(request, Exception::illegal_data_value);
}

/// Whether the request contains so many bytes of values, and says so.
bool has_values(std::string_view request, std::size_t bytes)
{
  return request.size() == values_at + bytes && get_u8(request, byte_count_at) == bytes;
}

std::string write_bits(PortMap & ports, std::string_view request)
{
  constexpr unsigned limit = 1968;
  const auto span = read_span(request, limit);
  if (!span || !has_values(request, (span->quantity + 7) / 8)) {
    return exception_response(request, Exception::illegal_data_value);
  }
  std::vector<bool> values(span->quantity);
  for (unsigned i = 0; i < span->quantity; ++i) {
    values[i] = (get_u8(request, values_at + i / 8) >> i % 8 & 1U) != 0;
  }
  return write_values(ports, request, bit_writer, values);
}

std::string write_registers(PortMap & ports, std::string_view request)
{
  constexpr unsigned limit = 123;
  const auto span = read_span(request, limit);
  if (!span || !has_values(request, std::size_t{2} * span->quantity)) {
    return exception_response(request, Exception::illegal_data_value);
  }
  std::vector<std::uint16_t> values(span->quantity);
  for (unsigned i = 0; i < span->quantity; ++i) {
    values[i] = get_u16(request, values_at + std::size_t{2} * i);
  }
  return write_values(ports, request, register_writer, values);
}

}  // namespace

std::string execute(PortMap & ports, std::string_view request)
{
  switch (get_u8(request, 0)) {
    case read_coils:
    case read_discrete_inputs:
      return read_bits(ports, request);
    case read_holding_registers:
    case read_input_registers:
      return read_registers(ports, request);
    case write_single_coil:
      return write_bit(ports, request);
    case write_single_register:
      return write_register(ports, request);
    case write_multiple_coils:
      return write_bits(ports, request);
    case write_multiple_registers:
      return write_registers(ports, request);
    default:
      return exception_response(request, Exception::illegal_function);
  }
}

}  // namespace ur_simulator::modbus
