#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ur_simulator {

// Big-endian numbers in messages.

inline void put_u8(std::string & to, std::uint8_t value)
{
  to += static_cast<char>(value);
}

inline void put_u16(std::string & to, std::uint16_t value)
{
  put_u8(to, static_cast<std::uint8_t>(value >> 8));
  put_u8(to, static_cast<std::uint8_t>(value));
}

inline void put_u32(std::string & to, std::uint32_t value)
{
  for (int shift = 24; shift >= 0; shift -= 8) {
    to += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
  }
}

inline void put_u64(std::string & to, std::uint64_t value)
{
  put_u32(to, static_cast<std::uint32_t>(value >> 32));
  put_u32(to, static_cast<std::uint32_t>(value));
}

inline void put_f32(std::string & to, float value)
{
  put_u32(to, std::bit_cast<std::uint32_t>(value));
}

inline void put_f64(std::string & to, double value)
{
  put_u64(to, std::bit_cast<std::uint64_t>(value));
}

// The bytes that are read must exist.

inline std::uint8_t get_u8(std::string_view bytes, std::size_t at)
{
  return static_cast<std::uint8_t>(bytes[at]);
}

inline std::uint16_t get_u16(std::string_view bytes, std::size_t at)
{
  return static_cast<std::uint16_t>(get_u8(bytes, at) << 8 | get_u8(bytes, at + 1));
}

}  // namespace ur_simulator
