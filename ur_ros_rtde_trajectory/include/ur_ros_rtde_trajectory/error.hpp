#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace ur_ros_rtde {

/// Reason why a request was rejected or ended early. The values match ur_ros_rtde_msgs/msg/ErrorCode.
enum class ErrorCode : std::uint16_t {
  none = 0,
  invalid_goal = 1,
  busy = 2,
  not_ready = 3,
  canceled = 4,
  preempted = 5,
  timeout = 6,
  protective_stop = 7,
  emergency_stop = 8,
  safeguard_stop = 9,
  program_stopped = 10,
  link_lost = 11,
  rejected_by_robot = 12,
  not_reached = 13,
  unreachable = 14,
  exception = 15,
  shutdown = 16,
  not_supported = 17,
  safety_violation = 18,
  client_lost = 19,
  model_mismatch = 20,
  robot_in_use = 21,
};

/// Name of the enumerator; "unknown" for a value outside the enumeration.
const char * to_string(ErrorCode code);

/// Why something failed: `message` names the field or component, its value, the limit and the remedy.
struct Error {
  ErrorCode code = ErrorCode::none;
  std::string message;
};

/// A value or the Error why there is none. A result that is ignored is a compiler warning: a step of a stop
/// that has failed must lead to the next one.
template <class T>
class [[nodiscard]] Expected : public tl::expected<T, Error> {
 public:
  using tl::expected<T, Error>::expected;
  Expected(const tl::expected<T, Error> & other) : tl::expected<T, Error>(other) {}
  Expected(tl::expected<T, Error> && other) : tl::expected<T, Error>(std::move(other)) {}
};

/// Success, or the Error.
using Status = Expected<void>;

/// An Error for functions that return Expected or Status.
inline tl::unexpected<Error> failure(ErrorCode code, std::string message)
{
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

/// Error as an exception, for functions that cannot return Expected.
class RobotError : public std::runtime_error {
 public:
  explicit RobotError(Error error) : std::runtime_error(error.message), error_(std::move(error)) {}
  const Error & error() const { return error_; }

 private:
  Error error_;
};

}  // namespace ur_ros_rtde
