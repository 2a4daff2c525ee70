#pragma once

#include <cstdint>
#include <string>

/// Messages of the primary interface, as a controller sends them.
namespace ur_ros_rtde::test::primary {

inline std::string big_endian(std::uint32_t value)
{
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text.push_back(static_cast<char>(value >> static_cast<unsigned>(shift) & 0xFFU));
  }
  return text;
}

/// A robot message: size, type 20, timestamp, source, message type, body.
inline std::string package(char kind, const std::string & body)
{
  std::string rest = std::string(1, 20) + std::string(8, '\0') + "\xff" + std::string(1, kind) + body;
  return big_endian(static_cast<std::uint32_t>(rest.size() + 4)) + rest;
}

inline std::string text(const std::string & line)
{
  return package(0, line);
}

inline std::string exception(std::uint32_t line, const std::string & text)
{
  return package(10, big_endian(line) + big_endian(3) + text);
}

inline std::string key(const std::string & title, const std::string & text)
{
  return package(
      7, big_endian(1) + big_endian(0) + std::string(1, static_cast<char>(title.size())) + title + text);
}

}  // namespace ur_ros_rtde::test::primary
