#include "control_port/request_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_simulator::control_port {
namespace {

/// `element` is the name of the field, or of one of its elements.
double check_range(const std::string & name, const std::string & element, const nlohmann::json & value,
                   Range range)
{
  if (!value.is_number()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a number", element, value.dump()), name);
  }
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < range.min || number > range.max) {
    throw RequestError(fmt::format("field '{}' is {}: it must be between {} and {}", element, value.dump(),
                                   range.min, range.max),
                       name);
  }
  return number;
}

}  // namespace

RequestFields::RequestFields(const nlohmann::json & request) : request_(request)
{
  read_names_.emplace_back("command");
}

bool RequestFields::has(std::string_view name) const
{
  return request_.contains(name);
}

const nlohmann::json * RequestFields::find(const std::string & name, bool optional)
{
  read_names_.push_back(name);
  const auto found = request_.find(name);
  if (found != request_.end()) {
    return &*found;
  }
  if (!optional) {
    throw RequestError(fmt::format("field '{}' is missing", name));
  }
  return nullptr;
}

double RequestFields::number(const std::string & name, Range range, std::optional<double> default_value)
{
  const nlohmann::json * value = find(name, default_value.has_value());
  return value == nullptr ? *default_value : check_range(name, name, *value, range);
}

std::int64_t RequestFields::integer(const std::string & name, std::int64_t min, std::int64_t max,
                                    std::optional<std::int64_t> default_value)
{
  const nlohmann::json * value = find(name, default_value.has_value());
  if (value == nullptr) {
    return *default_value;
  }
  if (!value->is_number_integer() ||
      (value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX) ||
      value->get<std::int64_t>() < min || value->get<std::int64_t>() > max) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a whole number from {} to {}", name,
                                   value->dump(), min, max),
                       name);
  }
  return value->get<std::int64_t>();
}

bool RequestFields::boolean(const std::string & name, std::optional<bool> default_value)
{
  const nlohmann::json * value = find(name, default_value.has_value());
  if (value == nullptr) {
    return *default_value;
  }
  if (!value->is_boolean()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be true or false", name, value->dump()), name);
  }
  return value->get<bool>();
}

std::string RequestFields::string(const std::string & name, std::optional<std::string> default_value)
{
  const nlohmann::json * value = find(name, default_value.has_value());
  if (value == nullptr) {
    return *default_value;
  }
  if (!value->is_string()) {
    throw RequestError(fmt::format("field '{}' is {}: it must be a string", name, value->dump()), name);
  }
  return value->get<std::string>();
}

std::string RequestFields::choice(const std::string & name, std::span<const std::string_view> choices,
                                  std::optional<std::string> default_value)
{
  const std::string value = string(name, std::move(default_value));
  if (std::ranges::find(choices, value) == choices.end()) {
    throw RequestError(fmt::format("field '{}' is '{}': it must be one of {}", name, value,
                                   fmt::join(choices.begin(), choices.end(), ", ")),
                       name);
  }
  return value;
}

nlohmann::json RequestFields::scalar(const std::string & name)
{
  const nlohmann::json & value = *find(name, false);
  if (!value.is_boolean() && !value.is_number() && !value.is_string()) {
    throw RequestError(
        fmt::format("field '{}' is {}: it must be a boolean, a number or a string", name, value.dump()),
        name);
  }
  return value;
}

std::vector<double> RequestFields::numbers(const std::string & name, std::size_t count, Range range)
{
  const nlohmann::json & value = *find(name, false);
  if (!value.is_array() || value.size() != count) {
    throw RequestError(
        fmt::format("field '{}' is {}: it must be an array of {} numbers", name, value.dump(), count), name);
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(check_range(name, fmt::format("{}[{}]", name, i), value[i], range));
  }
  return result;
}

Vector3 RequestFields::vector3(const std::string & name, Range range, std::optional<Vector3> default_value)
{
  if (default_value && !has(name)) {
    return *default_value;
  }
  return Vector3(numbers(name, 3, range).data());
}

Vector6 RequestFields::vector6(const std::string & name, Range range, std::optional<Vector6> default_value)
{
  if (default_value && !has(name)) {
    return *default_value;
  }
  return Vector6(numbers(name, 6, range).data());
}

void RequestFields::reject_unknown() const
{
  for (const auto & [name, value] : request_.items()) {
    if (std::ranges::find(read_names_, name) == read_names_.end()) {
      throw RequestError(fmt::format("field '{}' is not known to this command: see \"help\"", name), name);
    }
  }
}

}  // namespace ur_simulator::control_port
