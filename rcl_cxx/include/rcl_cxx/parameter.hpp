#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "rcl_cxx/parameter_value.hpp"

namespace rcl_cxx {
/// A parameter of a node: its name and its value.
struct Parameter {
  std::string name;
  ParameterValue value;

  bool operator==(const Parameter &) const = default;
};

/// from_value <= value <= to_value; with a step > 0, (value - from_value) is a whole multiple of it, or value
/// is `to_value`.
struct FloatingPointRange {
  double from_value;
  double to_value;
  double step = 0.0;
};

/// As FloatingPointRange, of integers.
struct IntegerRange {
  std::int64_t from_value;
  std::int64_t to_value;
  std::uint64_t step = 0;
};

/// The part of rcl_interfaces/msg/ParameterDescriptor that the user of a node chooses.
struct ParameterDescriptor {
  std::string description{};
  std::string additional_constraints{};
  bool read_only = false;
  std::optional<FloatingPointRange> floating_point_range{};
  std::optional<IntegerRange> integer_range{};
};

/// The error is the reason why the parameters were not set.
using SetParametersResult = tl::expected<void, std::string>;

}  // namespace rcl_cxx
