#pragma once

#include <string>
#include <utility>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Why a goal has to stop early: canceled, preempted, client lost, shutdown, robot stopped, connection lost,
/// timeout.
using StopReason = Error;

/// How a goal ended. An Error, and thus a StopReason, converts to an Outcome.
class [[nodiscard]] Outcome {
 public:
  Outcome(Error error) : error_(std::move(error)) {}
  Outcome(const Status & status) : error_(status ? Error{} : status.error()) {}

  /// `message` describes what was done.
  static Outcome success(std::string message = {})
  {
    return Outcome(Error{ErrorCode::none, std::move(message)});
  }
  static Outcome failure(ErrorCode code, std::string message)
  {
    return Outcome(Error{code, std::move(message)});
  }

  /// True for a success.
  explicit operator bool() const { return error_.code == ErrorCode::none; }
  /// The code is `none` after success.
  ErrorCode code() const { return error_.code; }
  const std::string & message() const { return error_.message; }
  const Error & error() const { return error_; }

 private:
  Error error_;
};

}  // namespace ur_ros_rtde
