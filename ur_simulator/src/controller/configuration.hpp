#pragma once

#include <chrono>

#include "kinematics/robot_model.hpp"
#include "polyscope/pendant.hpp"
#include "safety/limits.hpp"
#include "ur_simulator/simulated_controller.hpp"
#include "version/polyscope_version.hpp"
#include "world/world.hpp"

namespace ur_simulator {

// What the options of a simulated controller mean. Each throws std::runtime_error, with option, value and
// what there is, when they make no sense.

const RobotModel & model_of(const SimulatorOptions & options);
PolyscopeVersion version_of(const SimulatorOptions & options, const RobotModel & model);
Vector6 joints_of(const SimulatorOptions & options, const RobotModel & model);
/// Of the host's time, for one control cycle.
std::chrono::steady_clock::duration period_of(const SimulatorOptions & options,
                                              const PolyscopeVersion & version);
SafetyTimes safety_times(const SimulatorOptions & options);
PendantOptions pendant_options(const SimulatorOptions & options, const PolyscopeVersion & version);
World world_of(const SimulatorOptions & options, double cycle_time);

}  // namespace ur_simulator
