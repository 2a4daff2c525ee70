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
  constexpr std::string_view names[] = {"not set",      "bool",        "integer",    "double",
                                        "string",       "byte_array",  "bool_array", "integer_array",
                                        "double_array", "string_array"};
  const auto index = static_cast<std::size_t>(type);
  return index < std::size(names) ? names[index] : "invalid";
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

void ParameterValue::throw_does_not_fit(const std::string & value)
{
  throw Error(fmt::format("the value {} does not fit into the requested integer type", value));
}

}  // namespace rcl_cxx
