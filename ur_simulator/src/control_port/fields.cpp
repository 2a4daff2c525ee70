#include "control_port/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_simulator::control_port {
namespace {

double checked(const std::string & name, const nlohmann::json & value, Range range)
{
  if (!value.is_number()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a number", name, value.dump()));
  }
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < range.least || number > range.most) {
    throw RequestError(fmt::format("field '{}' is {}: it must be between {} and {}", name, value.dump(),
                                   range.least, range.most));
  }
  return number;
}

}  // namespace

Fields::Fields(const nlohmann::json & request) : request_(request)
{
  read_.emplace_back("command");
}

bool Fields::has(std::string_view name) const
{
  return request_.contains(name);
}

const nlohmann::json * Fields::find(const std::string & name, bool optional)
{
  read_.push_back(name);
  const auto found = request_.find(name);
  if (found != request_.end()) {
    return &*found;
  }
  if (!optional) {
    throw RequestError(fmt::format("field '{}' is missing", name));
  }
  return nullptr;
}

double Fields::number(const std::string & name, Range range, std::optional<double> fallback)
{
  const nlohmann::json * value = find(name, fallback.has_value());
  return value == nullptr ? *fallback : checked(name, *value, range);
}

std::int64_t Fields::integer(const std::string & name, std::int64_t least, std::int64_t most,
                             std::optional<std::int64_t> fallback)
{
  const nlohmann::json * value = find(name, fallback.has_value());
  if (value == nullptr) {
    return *fallback;
  }
  if (!value->is_number_integer() ||
      (value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX) ||
      value->get<std::int64_t>() < least || value->get<std::int64_t>() > most) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a whole number from {} to {}", name,
                                   value->dump(), least, most));
  }
  return value->get<std::int64_t>();
}

bool Fields::boolean(const std::string & name, std::optional<bool> fallback)
{
  const nlohmann::json * value = find(name, fallback.has_value());
  if (value == nullptr) {
    return *fallback;
  }
  if (!value->is_boolean()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be true or false", name, value->dump()));
  }
  return value->get<bool>();
}

std::string Fields::text(const std::string & name, std::optional<std::string> fallback)
{
  const nlohmann::json * value = find(name, fallback.has_value());
  if (value == nullptr) {
    return *fallback;
  }
  if (!value->is_string()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a string", name, value->dump()));
  }
  return value->get<std::string>();
}

std::string Fields::choice(const std::string & name, std::span<const std::string_view> choices,
                           std::optional<std::string> fallback)
{
  const std::string value = text(name, std::move(fallback));
  if (std::ranges::find(choices, value) == choices.end()) {
    throw RequestError(fmt::format("field '{}' is '{}': it must be one of {}", name, value,
                                   fmt::join(choices.begin(), choices.end(), ", ")));
  }
  return value;
}

std::vector<double> Fields::numbers(const std::string & name, std::size_t count, Range range)
{
  const nlohmann::json & value = *find(name, false);
  if (!value.is_array() || value.size() != count) {
    throw RequestError(
        fmt::format("field '{}' is {}: it must be an array of {} numbers", name, value.dump(), count));
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(checked(fmt::format("{}[{}]", name, i), value[i], range));
  }
  return result;
}

Vector3 Fields::vector3(const std::string & name, Range range, std::optional<Vector3> fallback)
{
  if (fallback && !has(name)) {
    return *fallback;
  }
  return Vector3(numbers(name, 3, range).data());
}

Vector6 Fields::vector6(const std::string & name, Range range, std::optional<Vector6> fallback)
{
  if (fallback && !has(name)) {
    return *fallback;
  }
  return Vector6(numbers(name, 6, range).data());
}

void Fields::finish() const
{
  for (const auto & [name, value] : request_.items()) {
    if (std::ranges::find(read_, name) == read_.end()) {
      throw RequestError(fmt::format("field '{}' is not known to this command: see \"help\"", name));
    }
  }
}

}  // namespace ur_simulator::control_port
