#pragma once

#include <string>

namespace ur_simulator {

/// Why a motion could not go on; ends in a protective stop.
struct MotionFault {
  enum class Kind { singularity, joint_position_limit, joint_speed_limit, unreachable, force_mode_deviation };
  Kind kind;
  int joint = -1;  ///< 0..5 where one joint is to blame; force_mode_deviation: the axis of the task frame
  double value = 0.0;
  double limit = 0.0;
};

/// One sentence for the log, with the joint's name, value and limit.
std::string describe(const MotionFault & fault);

}  // namespace ur_simulator
