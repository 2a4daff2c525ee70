#pragma once

#include <string_view>

namespace ur_simulator {

/// The text without these characters at its beginning and end.
inline std::string_view trim(std::string_view text, std::string_view characters)
{
  const std::size_t first = text.find_first_not_of(characters);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(characters) - first + 1);
}

}  // namespace ur_simulator
