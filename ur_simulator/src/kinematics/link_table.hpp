#pragma once

#include <array>
#include <string_view>

#include "kinematics/robot_model.hpp"

namespace ur_simulator {

/// Masses, centers of mass and inertias of the six links of a model ("ur10e"). Throws std::invalid_argument
/// if the name is unknown.
const std::array<Link, 6> & model_links(std::string_view model);

}  // namespace ur_simulator
