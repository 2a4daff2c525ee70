#pragma once

#include <stdexcept>
#include <string>

namespace rcl_cxx {
/// A function of rcl, rcl_action or rmw failed, or an argument is invalid. what() names the entity and
/// contains rcl's error message; rcl's error state is reset.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string & what, int code = 1) : std::runtime_error(what), code_(code) {}

  /// The rcl_ret_t of the failed function; RCL_RET_ERROR (1) if no rcl function was involved.
  int code() const noexcept { return code_; }

 private:
  int code_;
};

/// A parameter is not declared, declared twice, of the wrong type or out of range.
class ParameterError : public Error {
 public:
  ParameterError(std::string parameter, const std::string & what)
      : Error(what), parameter_(std::move(parameter))
  {
  }

  const std::string & parameter() const noexcept { return parameter_; }

 private:
  std::string parameter_;
};

}  // namespace rcl_cxx
