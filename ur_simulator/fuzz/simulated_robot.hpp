#pragma once

#include <optional>
#include <string>
#include <utility>

#include "kinematics/robot_model.hpp"
#include "polyscope/pendant.hpp"
#include "safety/collision_monitor.hpp"
#include "world/world.hpp"

namespace ur_simulator::fuzz {

/// A robot with its pendant and without servers. reset() makes a new robot at the same addresses.
class SimulatedRobot {
 public:
  explicit SimulatedRobot(const char * model_name, const char * version)
      : model(find_robot_model(model_name)->get()), options_{*PolyscopeVersion::parse(version), true, "1", ""}
  {
    reset();
  }

  void reset()
  {
    pendant.reset();
    runner.reset();
    state = ControllerState();
    arm.emplace(model, options_.version.cycle_time(), default_position(model));
    world.emplace(model, 1);
    collisions.reset();
    arm->teleport(default_position(model), state);
    initial_state_ = state;
    reset_controller();
  }

  /// The same without arm and world. Sufficient if no program has run, and takes a fraction of the time.
  void reset_controller()
  {
    pendant.reset();
    runner.reset();
    state = initial_state_;
    log = EventLog();
    watchdog = Watchdog();
    const double cycle_time = options_.version.cycle_time();
    safety.emplace(model, cycle_time);
    if (!library_) {
      ScriptRequests requests;
      requests.power_down = [] {};
      requests.protective_stop = [this](const ErrorCode &, const std::string &) { protective_stop_ = true; };
      library_ = make_robot_library({state, *arm, *world, model, watchdog, requests, cycle_time, nullptr});
    }
    runner.emplace(ProgramContext{state, *arm, *world, watchdog, log, library_, cycle_time});
    pendant.emplace(model, options_, state, *safety, *runner, log);
    pendant->set_program_request(
        [](const ProgramHost &, const auto & done) { done(tl::unexpected<std::string>("no host")); });
    safety->start_running(state);
  }

  /// The part of a control cycle that runs programs. Motion and world stand still: the target `urscript`
  /// moves the arm.
  void cycle()
  {
    ++state.cycle;
    state.timestamp = static_cast<double>(state.cycle) * options_.version.cycle_time();
    log.set_time(state.timestamp);
    runner->cycle();
    if (std::exchange(protective_stop_, false)) {
      safety->trigger_protective_stop("protective_stop()");
    }
  }

  const RobotModel & model;
  ControllerState state;
  EventLog log;
  Watchdog watchdog;
  std::optional<Arm> arm;
  std::optional<World> world;
  std::optional<Safety> safety;
  CollisionMonitor collisions{model};
  std::optional<ProgramRunner> runner;
  std::optional<Pendant> pendant;

 private:
  bool protective_stop_ = false;  ///< requested by the program in this cycle
  PendantOptions options_;
  ControllerState initial_state_;
  std::shared_ptr<const urscript::Library> library_;
};

}  // namespace ur_simulator::fuzz
