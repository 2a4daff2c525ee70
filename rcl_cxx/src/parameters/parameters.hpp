#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// The parameters that one call has declared or set.
struct ParameterChanges {
  std::vector<Parameter> added;
  std::vector<Parameter> changed;
};

/// The parameters of a node. Thread-safe.
class Parameters {
 public:
  struct Entry {
    ParameterValue value;
    ParameterDescriptor descriptor;
  };
  /// Runs under the lock, after a change has taken effect. May read parameters, must not set any.
  using OnChange = std::function<void(const ParameterChanges &)>;

  explicit Parameters(std::map<std::string, ParameterValue> overrides) : overrides_(std::move(overrides)) {}

  void add_on_change(OnChange callback);
  /// Waits for running callbacks.
  void remove_on_change();

  /// @throws ParameterError
  ParameterValue declare(const std::string & name, const ParameterValue & default_value,
                         const ParameterDescriptor & descriptor);

  bool has(const std::string & name) const;
  /// @throws ParameterError if not declared
  Entry get(const std::string & name) const;
  std::vector<Parameter> all() const;
  std::vector<std::string> undeclared_overrides() const;
  /// Sets all parameters or none.
  SetParametersResult set(const std::vector<Parameter> & parameters);

 private:
  SetParametersResult check(const Parameter & parameter) const;
  void notify(const ParameterChanges & changes) const;

  mutable std::recursive_mutex mutex_;
  const std::map<std::string, ParameterValue> overrides_;
  std::map<std::string, Entry> entries_;
  std::vector<OnChange> on_change_;
};

}  // namespace rcl_cxx::detail
