#pragma once

#include <string>

#include "common/error_code.hpp"

namespace ur_simulator {

/// The reason why a motion cannot continue. The controller reacts with a protective stop.
struct MotionFault {
  enum class Kind { singularity, joint_position_limit, joint_speed_limit, unreachable, force_mode_deviation };
  /// What is too large, of a singularity or joint speed limit.
  enum class Quantity { speed, acceleration };
  Kind kind;
  int joint = -1;  ///< 0..5: the joint concerned; force_mode_deviation: the axis of the task frame; -1: none
  double value = 0.0;
  double limit = 0.0;
  Quantity quantity = Quantity::speed;
};

/// The log text: joint, value, limit and remedy.
std::string describe(const MotionFault & fault);
ErrorCode error_code_of(const MotionFault & fault);

}  // namespace ur_simulator
