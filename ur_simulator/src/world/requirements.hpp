#pragma once

#include <string>

namespace ur_simulator {

/// Throw std::invalid_argument unless the requirement is met.
void require(bool condition, const std::string & message);
/// The message names field, value and limits; NaN is out of range.
void require_within(const std::string & field, double value, double min, double max);

}  // namespace ur_simulator
