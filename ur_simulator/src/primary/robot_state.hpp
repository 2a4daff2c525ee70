#pragma once

#include <string>

#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator::primary {

/// The robot state message (type 16) that ports 30001 and 30002 send ten times a second: sub-packages robot
/// mode, joint, tool and masterboard data, cartesian and kinematics information, configuration, force mode
/// data, additional information. UR, "Client Interface", sheet "Primary / Secondary" of PolyScope 5.10 and
/// later; a CB3 is sent the same.
std::string robot_state_message(const RobotModel & model, const ControllerState & state);

}  // namespace ur_simulator::primary
