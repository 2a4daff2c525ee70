#pragma once

#include <stdexcept>
#include <string>

namespace rcl_cxx {
/// A call into rcl, rcl_action or rmw failed, or an argument was refused. what() names the entity and carries
/// rcl's own text; rcl's error state has been reset by the time this is thrown.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string & what, int code = 1) : std::runtime_error(what), code_(code) {}

  /// rcl_ret_t of the failed call (rcl/types.h); 1 (RCL_RET_ERROR) where no rcl call was involved.
  int code() const noexcept { return code_; }

 private:
  int code_;
};

/// A parameter was used against its declaration: unknown, declared twice, wrong type, out of range, refused.
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
