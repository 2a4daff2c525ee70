#include "parameter_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rcl_cxx::detail {
namespace {
bool nearly_equal(double a, double b)
{
  // As rclcpp: the steps of a range are computed, their sums carry rounding errors.
  return a == b || (std::isfinite(a) && std::isfinite(b) &&
                    std::abs(a - b) <= std::numeric_limits<double>::epsilon() * 100.0 * std::abs(a + b));
}

bool within(double value, const FloatingPointRange & range)
{
  if (nearly_equal(value, range.from) || nearly_equal(value, range.to)) {
    return true;
  }
  if (!(value >= range.from && value <= range.to)) {  // also refuses NaN
    return false;
  }
  return range.step == 0.0 ||
         nearly_equal(value, range.from + std::round((value - range.from) / range.step) * range.step);
}

bool within(std::int64_t value, const IntegerRange & range)
{
  if (value < range.from || value > range.to) {
    return false;
  }
  const auto distance = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(range.from);
  return value == range.to || range.step == 0 || distance % range.step == 0;
}

template <typename Range>
ParameterResult outside(const std::string & name, const ParameterValue & value, const Range & range)
{
  const std::string steps = range.step == 0 ? "" : fmt::format(" in steps of {}", range.step);
  return tl::make_unexpected(fmt::format("parameter '{}' is limited to the range {} to {}{}, it cannot be {}",
                                         name, range.from, range.to, steps, value.to_string()));
}

template <typename Element, typename Range>
ParameterResult check_range(const std::string & name, const ParameterValue & value, const Range & range)
{
  const auto fits = [&range](Element element) { return within(element, range); };
  if (const auto * single = std::get_if<Element>(&value.variant())) {
    return fits(*single) ? ParameterResult{} : outside(name, value, range);
  }
  if (const auto * array = std::get_if<std::vector<Element>>(&value.variant())) {
    return std::all_of(array->begin(), array->end(), fits) ? ParameterResult{} : outside(name, value, range);
  }
  return {};
}
}  // namespace

ParameterResult check_value(const std::string & name, ParameterType type, const ParameterOptions & options,
                            const ParameterValue & value)
{
  if (!options.dynamic_typing && value.type() != type) {
    return tl::make_unexpected(
        fmt::format("Wrong parameter type: parameter '{}' is of type {}, it cannot be {} ({})", name,
                    to_string(type), value.to_string(), to_string(value.type())));
  }
  ParameterResult result;
  if (options.floating_point_range) {
    result = check_range<double>(name, value, *options.floating_point_range);
  }
  if (result && options.integer_range) {
    result = check_range<std::int64_t>(name, value, *options.integer_range);
  }
  return result;
}

ParameterValue as_type(const ParameterValue & value, ParameterType type)
{
  if (type == ParameterType::real && value.type() == ParameterType::integer) {
    return static_cast<double>(value.get<std::int64_t>());
  }
  if (type == ParameterType::real_array && value.type() == ParameterType::integer_array) {
    const auto integers = value.get<std::vector<std::int64_t>>();
    return std::vector<double>(integers.begin(), integers.end());
  }
  return value;
}

}  // namespace rcl_cxx::detail
