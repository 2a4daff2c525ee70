#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "raw_socket.hpp"

namespace ur_simulator::testing {

inline std::string big_endian(std::uint64_t value, int bytes)
{
  std::string result;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    result += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
  }
  return result;
}
inline std::string int32(std::int32_t value)
{
  return big_endian(static_cast<std::uint32_t>(value), 4);
}
inline std::string float64(double value)
{
  return big_endian(std::bit_cast<std::uint64_t>(value), 8);
}

/// The beginning of a data package: its recipe.
inline std::string package_for(int recipe)
{
  return std::string(1, static_cast<char>(recipe));
}

inline std::uint64_t number(std::string_view bytes)
{
  std::uint64_t value = 0;
  for (const char byte : bytes) {
    value = value << 8 | static_cast<std::uint8_t>(byte);
  }
  return value;
}
inline double real(std::string_view bytes)
{
  return std::bit_cast<double>(number(bytes));
}

/// Speaks RTDE byte by byte.
class RtdeClient {
 public:
  struct Package {
    char type;
    std::string payload;
  };

  explicit RtdeClient(const std::string & address, std::uint16_t port = 30004) : socket_(address, port) {}

  static std::string package(char type, std::string_view payload)
  {
    return big_endian(payload.size() + 3, 2) + type + std::string(payload);
  }
  void send(char type, std::string_view payload) { socket_.send(package(type, payload)); }
  void send_raw(std::string_view bytes) { socket_.send(bytes); }
  Package receive()
  {
    const std::string header = socket_.receive(3);
    return {header[2], socket_.receive(number(header.substr(0, 2)) - 3)};
  }
  /// The next package of that type, others are skipped.
  Package receive(char type)
  {
    for (Package next = receive();; next = receive()) {
      if (next.type == type) {
        return next;
      }
    }
  }
  std::string request(char type, std::string_view payload)
  {
    send(type, payload);
    return receive(type).payload;
  }
  bool negotiate(unsigned version) { return request('V', big_endian(version, 2)) == "\1"; }
  std::string outputs(double frequency, std::string_view names)
  {
    return request('O', float64(frequency) + std::string(names));
  }
  std::string inputs(std::string_view names) { return request('I', names); }
  bool start() { return request('S', "") == "\1"; }
  RawSocket & socket() { return socket_; }

 private:
  RawSocket socket_;
};

}  // namespace ur_simulator::testing
