#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"

namespace ur_simulator {

struct MoveOptions;

/// Why a motion cannot start: field, value and limit. Nothing when it can.
using Refusal = std::optional<std::string>;

Refusal not_finite(std::string_view call, std::string_view field, const Vector6 & values);
/// Refused unless least <= value <= most.
Refusal not_within(std::string_view call, std::string_view field, double value, double least, double most);
/// Refused unless finite and > 0.
Refusal not_positive(std::string_view call, std::string_view field, double value);
Refusal beyond_joint_limits(std::string_view call, const RobotModel & model, const Vector6 & target);
Refusal bad_options(std::string_view call, const MoveOptions & options);
/// The first of them that refuses.
Refusal first_of(std::initializer_list<Refusal> refusals);

}  // namespace ur_simulator
