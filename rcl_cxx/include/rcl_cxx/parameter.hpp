#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "rcl_cxx/parameter_value.hpp"

namespace rcl_cxx {
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

struct IntegerRange {
  std::int64_t from_value;
  std::int64_t to_value;
  std::uint64_t step = 0;
};

/// What rcl_interfaces/msg/ParameterDescriptor says about a parameter.
struct ParameterDescriptor {
  std::string description{};
  std::string additional_constraints{};
  bool read_only = false;
  std::optional<FloatingPointRange> floating_point_range{};
  std::optional<IntegerRange> integer_range{};
  /// The type may change by setting. Otherwise it is that of the default.
  bool dynamic_typing = false;
  /// Take the default even if command line or parameter file say otherwise.
  bool ignore_override = false;
};

/// Nothing, or the reason of a refusal.
using SetParametersResult = tl::expected<void, std::string>;

/// Looks at a set of parameters before any of them is set; a refusal refuses all of them, with its reason.
using OnSetParametersCallback = std::function<SetParametersResult(const std::vector<Parameter> &)>;
/// Told of parameters that have been set.
using PostSetParametersCallback = std::function<void(const std::vector<Parameter> &)>;

/// Keeps a parameter callback registered. Destroying it unregisters.
using ParameterCallbackHandle = std::shared_ptr<void>;

}  // namespace rcl_cxx
