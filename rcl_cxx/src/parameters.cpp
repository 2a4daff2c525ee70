#include "parameters.hpp"

#include <fmt/format.h>

#include "parameter_rules.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr const char * kNotInCallbacks = "parameters cannot be declared or set from a parameter callback";

ParameterError not_declared(const std::string & name)
{
  return {name, fmt::format("parameter '{}' is not declared", name)};
}

void check_declaration(const std::string & name, const ParameterValue & value,
                       const ParameterDescriptor & options)
{
  if (name.empty()) {
    throw ParameterError(name, "a parameter needs a name");
  }
  if (!options.dynamic_typing && value.get_type() == ParameterType::not_set) {
    throw ParameterError(name, fmt::format("parameter '{}' has neither a default nor dynamic typing", name));
  }
}
}  // namespace

/// A callback that changes parameters would change what is just being decided.
class Parameters::NoSettingInCallbacks {
 public:
  explicit NoSettingInCallbacks(Parameters & parameters) : parameters_(parameters)
  {
    if (parameters_.in_callback_) {
      throw Error(kNotInCallbacks);
    }
    parameters_.in_callback_ = true;
  }
  ~NoSettingInCallbacks() { parameters_.in_callback_ = false; }
  NoSettingInCallbacks(const NoSettingInCallbacks &) = delete;
  NoSettingInCallbacks & operator=(const NoSettingInCallbacks &) = delete;

 private:
  Parameters & parameters_;
};

Parameters::Parameters(Logger logger, std::map<std::string, ParameterValue> overrides)
    : logger_(std::move(logger)), overrides_(std::move(overrides))
{
}

void Parameters::observe(Observer observer)
{
  const std::lock_guard lock(mutex_);
  observer_ = std::move(observer);
}

ParameterValue Parameters::declare(const std::string & name, const ParameterValue & default_value,
                                   const ParameterDescriptor & options)
{
  check_declaration(name, default_value, options);
  const std::lock_guard lock(mutex_);
  const NoSettingInCallbacks guard(*this);
  if (entries_.contains(name)) {
    throw ParameterError(name, fmt::format("parameter '{}' is declared already", name));
  }
  const ParameterType type = default_value.get_type();
  ParameterValue value = default_value;
  const auto override = overrides_.find(name);
  if (override != overrides_.end() && !options.ignore_override) {
    value = options.dynamic_typing ? override->second : as_type(override->second, type);
  }
  const Parameter parameter{name, value};
  const SetParametersResult result =
      check_value(name, type, options, value).and_then([&] { return ask_callbacks({parameter}); });
  if (!result) {
    throw ParameterError(name, result.error());
  }
  entries_.emplace(name, Entry{value, options, value.get_type()});
  tell({parameter}, ParameterChanges{{parameter}, {}, {}});
  return value;
}

void Parameters::declare_all_overrides()
{
  ParameterDescriptor options;
  options.dynamic_typing = true;
  for (const auto & [name, value] : overrides_) {
    if (!has(name)) {
      declare(name, value, options);
    }
  }
}

void Parameters::undeclare(const std::string & name)
{
  const std::lock_guard lock(mutex_);
  const NoSettingInCallbacks guard(*this);
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    throw not_declared(name);
  }
  if (found->second.options.read_only || !found->second.options.dynamic_typing) {
    throw ParameterError(name,
                         fmt::format("parameter '{}' cannot be undeclared, it is {}", name,
                                     found->second.options.read_only ? "read-only" : "statically typed"));
  }
  entries_.erase(found);
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
    throw not_declared(name);
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

SetParametersResult Parameters::set(const std::vector<Parameter> & parameters)
{
  const std::lock_guard lock(mutex_);
  if (in_callback_) {
    return tl::make_unexpected(std::string(kNotInCallbacks));
  }
  const NoSettingInCallbacks guard(*this);
  const SetParametersResult result = check(parameters).and_then([&] { return ask_callbacks(parameters); });
  if (result) {
    tell(parameters, apply(parameters));
  }
  return result;
}

SetParametersResult Parameters::check(const std::vector<Parameter> & parameters) const
{
  for (const Parameter & parameter : parameters) {
    if (SetParametersResult result = check_one(parameter); !result) {
      return result;
    }
  }
  return {};
}

SetParametersResult Parameters::check_one(const Parameter & parameter) const
{
  const auto found = entries_.find(parameter.name);
  if (found == entries_.end()) {
    return tl::make_unexpected(
        fmt::format("parameter '{}' cannot be set because it was not declared", parameter.name));
  }
  const Entry & entry = found->second;
  if (entry.options.read_only) {
    return tl::make_unexpected(
        fmt::format("parameter '{}' cannot be set because it is read-only", parameter.name));
  }
  return check_value(parameter.name, entry.type, entry.options, parameter.value);
}

SetParametersResult Parameters::ask_callbacks(const std::vector<Parameter> & parameters) const
{
  for (const auto & weak : on_set_) {
    const auto callback = weak.lock();
    if (!callback) {
      continue;
    }
    try {
      if (SetParametersResult result = (*callback)(parameters); !result) {
        return result;
      }
    } catch (const std::exception & error) {
      return tl::make_unexpected(std::string(error.what()));
    }
  }
  return {};
}

ParameterChanges Parameters::apply(const std::vector<Parameter> & parameters)
{
  ParameterChanges changes;
  for (const Parameter & parameter : parameters) {
    const auto found = entries_.find(parameter.name);
    if (found == entries_.end()) {
      continue;  // deleted by an earlier one of the same set
    }
    Entry & entry = found->second;
    if (parameter.value.get_type() == ParameterType::not_set &&
        entry.value.get_type() != ParameterType::not_set) {
      // As in rclcpp: unsetting a parameter of dynamic type undeclares it.
      changes.deleted.push_back({parameter.name, entry.value});
      entries_.erase(found);
      continue;
    }
    entry.value = parameter.value;
    entry.type = parameter.value.get_type();
    changes.changed.push_back(parameter);
  }
  return changes;
}

void Parameters::tell(const std::vector<Parameter> & parameters, const ParameterChanges & changes) const
{
  for (const auto & weak : after_set_) {
    const auto callback = weak.lock();
    if (!callback) {
      continue;
    }
    try {
      (*callback)(parameters);
    } catch (const std::exception & error) {
      RCL_CXX_ERROR(logger_, "callback of set parameters: {}", error.what());
    }
  }
  if (observer_) {
    observer_(changes);
  }
}

ParameterCallbackHandle Parameters::add_on_set(OnSetParametersCallback callback)
{
  const std::lock_guard lock(mutex_);
  on_set_.remove_if([](const auto & other) { return other.expired(); });
  auto handle = std::make_shared<OnSetParametersCallback>(std::move(callback));
  on_set_.push_front(handle);
  return handle;
}

ParameterCallbackHandle Parameters::add_after_set(PostSetParametersCallback callback)
{
  const std::lock_guard lock(mutex_);
  after_set_.remove_if([](const auto & other) { return other.expired(); });
  auto handle = std::make_shared<PostSetParametersCallback>(std::move(callback));
  after_set_.push_front(handle);
  return handle;
}

}  // namespace rcl_cxx::detail
