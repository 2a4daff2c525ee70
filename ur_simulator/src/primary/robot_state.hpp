#pragma once

#include <string>

#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::primary {

/// The robot state message (message type 16) that ports 30001 and 30002 send at 10 Hz, with the sub-packages
/// robot mode, joint, tool and masterboard data, Cartesian and kinematics information, configuration, force
/// mode data and additional information, on e-Series controllers also tool communication and tool mode
/// information. Layout of the version (UR, "Client Interface", sheet "Primary / Secondary"; for PolyScope 3
/// also the parsers of ur_modern_driver).
std::string robot_state_message(const RobotModel & model, const PolyscopeVersion & version,
                                const ControllerState & state);

}  // namespace ur_simulator::primary
