#include "parameters/parameter_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcl_cxx::detail {
namespace {
bool nearly_equal(double a, double b)
{
  // As in rclcpp: multiples of the step carry rounding errors.
  return a == b || (std::isfinite(a) && std::isfinite(b) &&
                    std::abs(a - b) <= std::numeric_limits<double>::epsilon() * 100.0 * std::abs(a + b));
}

bool within(double value, const FloatingPointRange & range)
{
  if (nearly_equal(value, range.from_value) || nearly_equal(value, range.to_value)) {
    return true;
  }
  if (!(value >= range.from_value && value <= range.to_value)) {  // rejects NaN, too
    return false;
  }
  return range.step == 0.0 ||
         nearly_equal(value,
                      range.from_value + std::round((value - range.from_value) / range.step) * range.step);
}

bool within(std::int64_t value, const IntegerRange & range)
{
  if (value < range.from_value || value > range.to_value) {
    return false;
  }
  const auto distance = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(range.from_value);
  return value == range.to_value || range.step == 0 || distance % range.step == 0;
}

template <typename Range>
SetParametersResult outside(const std::string & name, const ParameterValue & value, const Range & range)
{
  const std::string steps = range.step == 0 ? "" : fmt::format(" in steps of {}", range.step);
  return tl::make_unexpected(fmt::format("parameter '{}' is limited to the range {} to {}{}, it cannot be {}",
                                         name, range.from_value, range.to_value, steps, value.to_string()));
}

template <typename Element, typename Range>
SetParametersResult check_range(const std::string & name, const ParameterValue & value, const Range & range)
{
  const auto fits = [&range](Element element) { return within(element, range); };
  if (const auto * single = std::get_if<Element>(&value.variant())) {
    return fits(*single) ? SetParametersResult{} : outside(name, value, range);
  }
  if (const auto * array = std::get_if<std::vector<Element>>(&value.variant())) {
    return std::all_of(array->begin(), array->end(), fits) ? SetParametersResult{}
                                                           : outside(name, value, range);
  }
  return {};
}
}  // namespace

SetParametersResult check_value(const Parameter & parameter, ParameterType type,
                                const ParameterDescriptor & descriptor)
{
  const auto & [name, value] = parameter;
  if (value.get_type() != type) {
    return tl::make_unexpected(
        fmt::format("Wrong parameter type: parameter '{}' is of type {}, it cannot be {} ({})", name,
                    to_string(type), value.to_string(), to_string(value.get_type())));
  }
  SetParametersResult result;
  if (descriptor.floating_point_range) {
    result = check_range<double>(name, value, *descriptor.floating_point_range);
  }
  if (result && descriptor.integer_range) {
    result = check_range<std::int64_t>(name, value, *descriptor.integer_range);
  }
  return result;
}

namespace {
/// rcl reads the empty list of a parameter file as a value that is not set.
ParameterValue empty_list(ParameterType type)
{
  switch (type) {
    case ParameterType::byte_array:
      return std::vector<std::uint8_t>{};
    case ParameterType::boolean_array:
      return std::vector<bool>{};
    case ParameterType::integer_array:
      return std::vector<std::int64_t>{};
    case ParameterType::floating_point_array:
      return std::vector<double>{};
    case ParameterType::string_array:
      return std::vector<std::string>{};
    default:
      return {};
  }
}
}  // namespace

ParameterValue as_type(const ParameterValue & value, ParameterType type)
{
  if (value.get_type() == ParameterType::not_set) {
    return empty_list(type);
  }
  if (type == ParameterType::floating_point && value.get_type() == ParameterType::integer) {
    return static_cast<double>(value.get<std::int64_t>());
  }
  if (type == ParameterType::floating_point_array && value.get_type() == ParameterType::integer_array) {
    const auto integers = value.get<std::vector<std::int64_t>>();
    return std::vector<double>(integers.begin(), integers.end());
  }
  return value;
}

}  // namespace rcl_cxx::detail
