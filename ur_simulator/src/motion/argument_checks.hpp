#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

struct MoveOptions;

/// Why a motion cannot start: the URScript function, the argument, its value and its limit. Nothing if it
/// can.
using Rejection = std::optional<std::string>;

Rejection check_finite(std::string_view function, std::string_view argument, const Vector6 & values);
/// Rejects unless min <= value <= max.
Rejection check_in_range(std::string_view function, std::string_view argument, double value, double min,
                         double max);
/// Rejects unless finite and > 0.
Rejection check_positive(std::string_view function, std::string_view argument, double value);
Rejection check_joint_limits(std::string_view function, const RobotModel & model, const Vector6 & target);
Rejection check_move_options(std::string_view function, const MoveOptions & options);
/// The first of the rejections that is set.
Rejection first_rejection(std::initializer_list<Rejection> rejections);

}  // namespace ur_simulator
