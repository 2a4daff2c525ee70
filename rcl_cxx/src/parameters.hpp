#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rcl_cxx/error.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/parameter.hpp"

namespace rcl_cxx::detail {
/// What has happened to a node's parameters in one go; parameters of /parameter_events.
struct ParameterChanges {
  std::vector<Parameter> added;
  std::vector<Parameter> changed;
  std::vector<Parameter> deleted;
};

/// The parameters of a node. Thread-safe; callbacks and the observer run under its lock, and may read but not
/// set.
class Parameters : public std::enable_shared_from_this<Parameters> {
 public:
  struct Entry {
    ParameterValue value;
    ParameterDescriptor options;
    ParameterType type;  // of the value, or the only one allowed
  };
  using Observer = std::function<void(const ParameterChanges &)>;

  Parameters(Logger logger, std::map<std::string, ParameterValue> overrides);

  /// Told of every change, after it.
  void observe(Observer observer);

  ParameterValue declare(const std::string & name, const ParameterValue & default_value,
                         const ParameterDescriptor & options);
  void declare_all_overrides();
  void undeclare(const std::string & name);

  bool has(const std::string & name) const;
  /// @throws ParameterError if not declared
  Entry get(const std::string & name) const;
  std::vector<Parameter> all() const;
  /// All or nothing.
  SetParametersResult set(const std::vector<Parameter> & parameters);

  ParameterCallbackHandle add_on_set(OnSetParametersCallback callback);
  ParameterCallbackHandle add_after_set(PostSetParametersCallback callback);

 private:
  class NoSettingInCallbacks;

  SetParametersResult check(const std::vector<Parameter> & parameters) const;
  SetParametersResult check_one(const Parameter & parameter) const;
  SetParametersResult ask_callbacks(const std::vector<Parameter> & parameters) const;
  ParameterChanges apply(const std::vector<Parameter> & parameters);
  void tell(const std::vector<Parameter> & parameters, const ParameterChanges & changes) const;

  const Logger logger_;
  mutable std::recursive_mutex mutex_;
  bool in_callback_ = false;
  const std::map<std::string, ParameterValue> overrides_;
  std::map<std::string, Entry> entries_;
  // Newest first. Pointers, so that one may unregister while it runs.
  std::list<std::weak_ptr<OnSetParametersCallback>> on_set_;
  std::list<std::weak_ptr<PostSetParametersCallback>> after_set_;
  Observer observer_;
};

}  // namespace rcl_cxx::detail
