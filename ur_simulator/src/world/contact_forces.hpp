#pragma once

#include "common/types.hpp"
#include "state/controller_state.hpp"
#include "world/objects.hpp"

namespace ur_simulator {

// Force of an object on the TCP in the base frame, N. The elasticity of the arm is in series with the object:
// `state` holds the TCP of a rigid arm, and the penetration is shared between arm and object.

Vector3 contact_force(const Surface & surface, const ControllerState & state);
/// That of the face nearest to the TCP, 0 outside.
Vector3 contact_force(const Box & box, const ControllerState & state);
Vector3 contact_force(const Spring & spring, const ControllerState & state);

}  // namespace ur_simulator
