#pragma once

#include <array>
#include <string_view>

#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// Masses, centres of mass and inertias of a model's six links ("ur10e"); std::invalid_argument for an
/// unknown name.
const std::array<Link, 6> & links_of(std::string_view model);

}  // namespace ur_simulator
