#include "version/polyscope_version.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace ur_simulator {

std::string PolyscopeVersion::to_string() const
{
  return fmt::format("{}.{}.{}.{}", major, minor, bugfix, build);
}

std::optional<PolyscopeVersion> PolyscopeVersion::parse(std::string_view text)
{
  std::array<std::uint32_t, 4> parts{};
  std::size_t count = 0;
  const char * position = text.data();
  const char * const end = position + text.size();
  while (count < parts.size()) {
    const auto [next, error] = std::from_chars(position, end, parts[count]);
    if (error != std::errc()) {
      return std::nullopt;
    }
    ++count;
    position = next;
    if (position == end) {
      break;
    }
    if (*position++ != '.') {
      return std::nullopt;
    }
  }
  if (position != end || count < 2) {
    return std::nullopt;
  }
  return PolyscopeVersion{parts[0], parts[1], parts[2], parts[3]};
}

}  // namespace ur_simulator
