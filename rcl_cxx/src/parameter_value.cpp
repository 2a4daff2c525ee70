#include "rcl_cxx/parameter_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rcl_cxx/error.hpp"

namespace rcl_cxx {
namespace {
std::string quoted(const std::string & text)
{
  return fmt::format("'{}'", text);
}

struct ToText {
  std::string operator()(std::monostate) const { return "not set"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return fmt::format("{:#}", value); }  // always with a point
  std::string operator()(const std::string & value) const { return quoted(value); }

  template <typename T>
  std::string operator()(const std::vector<T> & values) const
  {
    std::vector<std::string> texts;
    for (const auto & value : values) {
      if constexpr (std::is_same_v<T, std::uint8_t>) {
        texts.push_back(fmt::format("{:#04x}", value));
      } else {
        texts.push_back((*this)(static_cast<const T &>(value)));
      }
    }
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }
};
}  // namespace

std::string_view to_string(ParameterType type) noexcept
{
  switch (type) {
    case ParameterType::not_set:
      return "not set";
    case ParameterType::boolean:
      return "bool";
    case ParameterType::integer:
      return "integer";
    case ParameterType::floating_point:
      return "double";
    case ParameterType::string:
      return "string";
    case ParameterType::byte_array:
      return "byte_array";
    case ParameterType::boolean_array:
      return "bool_array";
    case ParameterType::integer_array:
      return "integer_array";
    case ParameterType::floating_point_array:
      return "double_array";
    case ParameterType::string_array:
      return "string_array";
  }
  return "invalid";
}

std::string ParameterValue::to_string() const
{
  return std::visit(ToText{}, value_);
}

void ParameterValue::throw_wrong_type(ParameterType wanted) const
{
  throw Error(fmt::format("the value {} is of type {}, not {}", to_string(), rcl_cxx::to_string(get_type()),
                          rcl_cxx::to_string(wanted)));
}

void ParameterValue::throw_does_not_fit(std::int64_t value, std::int64_t low, std::uint64_t high)
{
  throw Error(fmt::format("the value {} is not within {} and {}", value, low, high));
}

void ParameterValue::throw_too_large(std::uint64_t value)
{
  throw Error(fmt::format("the value {} does not fit into a parameter, integers go up to 2^63 - 1", value));
}

}  // namespace rcl_cxx
