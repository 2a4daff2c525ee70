#include "rcl_cxx/goal_uuid.hpp"

#include <fmt/format.h>

#include <cstring>
#include <iterator>
#include <random>

namespace rcl_cxx {
GoalUUID GoalUUID::random()
{
  std::random_device device;
  GoalUUID id;
  for (std::size_t i = 0; i < id.bytes.size(); i += 4) {
    const std::uint32_t word = device();
    std::memcpy(&id.bytes[i], &word, sizeof(word));
  }
  // RFC 9562: version 4, variant 10.
  id.bytes[6] = static_cast<std::uint8_t>((id.bytes[6] & 0x0fU) | 0x40U);
  id.bytes[8] = static_cast<std::uint8_t>((id.bytes[8] & 0x3fU) | 0x80U);
  return id;
}

std::string GoalUUID::to_string() const
{
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool dash = i == 4 || i == 6 || i == 8 || i == 10;
    text += fmt::format("{}{:02x}", dash ? "-" : "", bytes[i]);
  }
  return text;
}

std::string GoalUUID::short_string() const
{
  return to_string().substr(0, 8);
}

const char * to_string(GoalStatus status) noexcept
{
  constexpr const char * names[] = {"unknown",   "accepted", "executing", "canceling",
                                    "succeeded", "canceled", "aborted"};
  const auto index = static_cast<std::size_t>(status);
  return index < std::size(names) ? names[index] : "invalid";
}

}  // namespace rcl_cxx
