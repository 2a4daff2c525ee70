#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace ur_simulator::testing {

// Big-endian values, as in RTDE packages and messages of the client interfaces.

inline std::string encode_uint(std::uint64_t value, int bytes)
{
  std::string result;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    result += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
  }
  return result;
}
inline std::string encode_int32(std::int32_t value)
{
  return encode_uint(static_cast<std::uint32_t>(value), 4);
}
inline std::string encode_double(double value)
{
  return encode_uint(std::bit_cast<std::uint64_t>(value), 8);
}

inline std::uint64_t decode_uint(std::string_view bytes)
{
  std::uint64_t value = 0;
  for (const char byte : bytes) {
    value = value << 8 | static_cast<std::uint8_t>(byte);
  }
  return value;
}
inline double decode_double(std::string_view bytes)
{
  return std::bit_cast<double>(decode_uint(bytes));
}

}  // namespace ur_simulator::testing
