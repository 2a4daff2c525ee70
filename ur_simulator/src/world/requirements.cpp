#include "world/requirements.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace ur_simulator {

void require(bool condition, const std::string & message)
{
  if (!condition) {
    throw std::invalid_argument(message);
  }
}

void require_within(const std::string & field, double value, double min, double max)
{
  require(value >= min && value <= max, fmt::format("{} must be in [{}, {}], is {}", field, min, max, value));
}

}  // namespace ur_simulator
