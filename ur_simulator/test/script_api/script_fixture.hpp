#pragma once

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "script_api/robot_library.hpp"
#include "support/script_runner.hpp"
#include "world/world.hpp"

namespace ur_simulator {

/// A UR10e in robot mode RUNNING with a program, advanced cycle by cycle in the same order as by the
/// controller.
class ScriptFixture {
 public:
  ScriptFixture()
      : model(find_robot_model("ur10e")->get()),
        arm(model, cycle_time, default_position(model)),
        world(model, 1)
  {
    state.robot_mode = RobotMode::running;
    world.set_sensor_noise(0.0, 0.0);
    arm.teleport(default_position(model), state);
    ScriptRequests requests;
    requests.power_down = [this] { powered_down = true; };
    requests.protective_stop = [this](const ErrorCode & code, const std::string & reason) {
      protective_stop = code;
      stop_reason = reason;
    };
    library = make_robot_library({state, arm, world, model, watchdog, requests, cycle_time, &history});
  }

  void run(const std::string & text)
  {
    auto program = urscript::compile(text, *library);
    ASSERT_TRUE(program.has_value()) << program.error().text();
    machine = std::make_unique<urscript::Machine>(*program, library, host, options);
  }

  void cycle()
  {
    ++state.cycle;
    state.timestamp = static_cast<double>(state.cycle) * cycle_time;
    if (machine && !paused) {
      machine->cycle();
    }
    arm.step(state);
    world.step(state);
    history.record(state.actual.position);
  }

  void cycles(int count)
  {
    for (int i = 0; i < count; ++i) {
      cycle();
    }
  }

  /// Runs until the condition holds; the test fails after `limit` s of simulated time. Returns the elapsed
  /// time, s.
  double until(const std::function<bool()> & condition, double limit = 30.0)
  {
    const double start = state.timestamp;
    while (!condition() && state.timestamp - start < limit) {
      cycle();
    }
    EXPECT_TRUE(condition()) << "not within " << limit << " s; " << machine->error().message << " line "
                             << machine->error().line;
    return state.timestamp - start;
  }

  /// Runs until the program ends.
  double finish(double limit = 30.0)
  {
    return until([this] { return machine->status() != urscript::MachineStatus::running; }, limit);
  }

  /// Runs a program to its end. Returns the error message, "" if there is none.
  std::string error_of(const std::string & text)
  {
    run(text);
    finish();
    return machine->status() == urscript::MachineStatus::failed ? machine->error().message : "";
  }

  std::string global(const std::string & name) const
  {
    const urscript::Value * value = machine->global(name);
    return value == nullptr ? "" : value->text();
  }

  static constexpr double cycle_time = 0.002;
  const RobotModel & model;
  ControllerState state;
  Arm arm;
  World world;
  Watchdog watchdog;
  JointHistory history;
  std::shared_ptr<const urscript::Library> library;
  urscript::RecordingHost host;
  urscript::MachineOptions options;
  bool powered_down = false;
  std::optional<ErrorCode> protective_stop;
  std::string stop_reason;
  bool paused = false;
  std::unique_ptr<urscript::Machine> machine;
};

/// As a program contains it, in full precision.
inline std::string list_text(const Vector6 & values)
{
  return fmt::format("[{}]", fmt::join(values, ", "));
}
inline std::string pose_text(const Vector6 & values)
{
  return "p" + list_text(values);
}

}  // namespace ur_simulator
