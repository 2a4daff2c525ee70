#pragma once

#include <string>

#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator::primary {

/// The robot state message (message type 16) that ports 30001 and 30002 send at 10 Hz, with the sub-packages
/// robot mode, joint, tool and masterboard data, Cartesian and kinematics information, configuration, force
/// mode data and additional information. Layout of PolyScope 5.10 and later, for CB3 controllers too (UR,
/// "Client Interface", sheet "Primary / Secondary").
std::string robot_state_message(const RobotModel & model, const ControllerState & state);

}  // namespace ur_simulator::primary
