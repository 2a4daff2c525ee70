#include "parameters/parameters.hpp"

#include <fmt/format.h>

#include "parameters/parameter_rules.hpp"
#include "rcl_cxx/error.hpp"

namespace rcl_cxx::detail {
void Parameters::add_on_change(OnChange callback)
{
  const std::lock_guard lock(mutex_);
  on_change_.push_back(std::move(callback));
}

void Parameters::remove_on_change()
{
  const std::lock_guard lock(mutex_);
  on_change_.clear();
}

ParameterValue Parameters::declare(const std::string & name, const ParameterValue & default_value,
                                   const ParameterDescriptor & descriptor)
{
  if (name.empty() || default_value.get_type() == ParameterType::not_set) {
    throw ParameterError(name, fmt::format("parameter '{}' needs a name and a default value", name));
  }
  const std::lock_guard lock(mutex_);
  if (entries_.contains(name)) {
    throw ParameterError(name, fmt::format("parameter '{}' is declared already", name));
  }
  const ParameterType type = default_value.get_type();
  const auto override = overrides_.find(name);
  const Parameter parameter{name,
                            override == overrides_.end() ? default_value : as_type(override->second, type)};
  if (const SetParametersResult result = check_value(parameter, type, descriptor); !result) {
    throw ParameterError(name, result.error());
  }
  entries_.emplace(name, Entry{parameter.value, descriptor});
  notify({.added = {parameter}, .changed = {}});
  return parameter.value;
}

bool Parameters::has(const std::string & name) const
{
  const std::lock_guard lock(mutex_);
  return entries_.contains(name);
}

Parameters::Entry Parameters::get(const std::string & name) const
{
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    throw ParameterError(name, fmt::format("parameter '{}' is not declared", name));
  }
  return found->second;
}

std::vector<Parameter> Parameters::all() const
{
  const std::lock_guard lock(mutex_);
  std::vector<Parameter> list;
  for (const auto & [name, entry] : entries_) {
    list.push_back({name, entry.value});
  }
  return list;
}

std::vector<std::string> Parameters::undeclared_overrides() const
{
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const auto & [name, value] : overrides_) {
    if (!entries_.contains(name)) {
      names.push_back(name);
    }
  }
  return names;
}

SetParametersResult Parameters::set(const std::vector<Parameter> & parameters)
{
  const std::lock_guard lock(mutex_);
  for (const Parameter & parameter : parameters) {
    if (SetParametersResult result = check(parameter); !result) {
      return result;
    }
  }
  for (const Parameter & parameter : parameters) {
    entries_.at(parameter.name).value = parameter.value;
  }
  notify({.added = {}, .changed = parameters});
  return {};
}

SetParametersResult Parameters::check(const Parameter & parameter) const
{
  const auto found = entries_.find(parameter.name);
  if (found == entries_.end()) {
    return tl::make_unexpected(
        fmt::format("parameter '{}' cannot be set because it was not declared", parameter.name));
  }
  const Entry & entry = found->second;
  if (entry.descriptor.read_only) {
    return tl::make_unexpected(
        fmt::format("parameter '{}' cannot be set because it is read-only", parameter.name));
  }
  return check_value(parameter, entry.value.get_type(), entry.descriptor);
}

void Parameters::notify(const ParameterChanges & changes) const
{
  for (const OnChange & callback : on_change_) {
    callback(changes);
  }
}

}  // namespace rcl_cxx::detail
