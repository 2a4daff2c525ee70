#pragma once

#include <chrono>

#include "kinematics/robot_model.hpp"
#include "polyscope/pendant.hpp"
#include "safety/safety_limits.hpp"
#include "ur_simulator/simulated_controller.hpp"
#include "version/polyscope_version.hpp"
#include "world/world.hpp"

namespace ur_simulator {

// Evaluation of SimulatorOptions. All functions throw std::runtime_error for invalid options; the text states
// option, value and valid values.

/// With the calibration that the options select.
RobotModel select_model(const SimulatorOptions & options);
PolyscopeVersion select_version(const SimulatorOptions & options, const RobotModel & model);
Vector6 initial_joint_positions(const SimulatorOptions & options, const RobotModel & model);
/// Duration of a control cycle on the host's clock.
std::chrono::steady_clock::duration cycle_period(const SimulatorOptions & options,
                                                 const PolyscopeVersion & version);
/// Times of the safety system, scaled by SimulatorOptions::recovery_time_factor.
SafetyTimes safety_times(const SimulatorOptions & options);
PendantOptions pendant_options(const SimulatorOptions & options, const PolyscopeVersion & version);
World create_world(const SimulatorOptions & options, const RobotModel & model);

}  // namespace ur_simulator
