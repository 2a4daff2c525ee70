#pragma once

#include <initializer_list>
#include <string>

namespace ur_simulator::testing {

/// A binary message.
inline std::string bytes(std::initializer_list<int> values)
{
  std::string result;
  for (const int value : values) {
    result += static_cast<char>(value);
  }
  return result;
}

}  // namespace ur_simulator::testing
