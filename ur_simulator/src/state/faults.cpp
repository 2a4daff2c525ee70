#include "state/faults.hpp"

#include <fmt/format.h>

#include <array>

namespace ur_simulator {

namespace {

/// "turn at 3.50 rad/s (limit 3.14 rad/s)"
std::string joint_motion(const MotionFault & fault)
{
  return fault.quantity == MotionFault::Quantity::speed
             ? fmt::format("turn at {:.2f} rad/s (limit {:.2f} rad/s)", fault.value, fault.limit)
             : fmt::format("accelerate at {:.0f} rad/s^2 (limit {:.0f} rad/s^2)", fault.value, fault.limit);
}

}  // namespace

std::string describe(const MotionFault & fault)
{
  static constexpr std::array<const char *, 6> names{"base",    "shoulder", "elbow",
                                                     "wrist 1", "wrist 2",  "wrist 3"};
  const char * joint =
      fault.joint >= 0 && fault.joint < 6 ? names[static_cast<std::size_t>(fault.joint)] : "one joint";
  switch (fault.kind) {
    case MotionFault::Kind::singularity:
      return fmt::format(
          "the path leads through a singularity: joint {} would have to {}; move there with movej, or choose "
          "another path",
          joint, joint_motion(fault));
    case MotionFault::Kind::joint_position_limit:
      return fmt::format("joint {} reached its position limit: {:.4f} rad (limit {:.4f} rad)", joint,
                         fault.value, fault.limit);
    case MotionFault::Kind::joint_speed_limit:
      return fmt::format("joint {} would have to {}; move slower", joint, joint_motion(fault));
    case MotionFault::Kind::force_mode_deviation:
      return fmt::format(
          "force mode: the TCP deviates by {:.4f} m or rad from the program along axis {} of the task frame, "
          "which "
          "is not compliant (limit {:.4f}); press less, or raise the limit",
          fault.value, fault.joint, fault.limit);
    case MotionFault::Kind::unreachable:
      return "the path leads out of the robot's reach";
  }
  return "unknown motion fault";
}

ErrorCode error_code_of(const MotionFault & fault)
{
  switch (fault.kind) {
    case MotionFault::Kind::singularity:
      return error_codes::singularity;
    case MotionFault::Kind::joint_position_limit:
      return error_codes::close_to_joint_limits;
    case MotionFault::Kind::joint_speed_limit:
      return error_codes::sudden_change_of_target;
    case MotionFault::Kind::unreachable:
      return error_codes::invalid_setpoint;
    case MotionFault::Kind::force_mode_deviation:
      return error_codes::unnumbered_protective_stop;
  }
  return error_codes::unnumbered_protective_stop;
}

}  // namespace ur_simulator
