#pragma once

namespace ur_simulator {

// Electrical values of an operational robot. They are constant in the simulation.

constexpr double main_voltage = 48.0;       // V
constexpr double idle_robot_current = 0.6;  // A

}  // namespace ur_simulator
