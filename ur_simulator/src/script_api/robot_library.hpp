#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/error_code.hpp"
#include "script_api/interpreter_mode.hpp"
#include "script_api/joint_history.hpp"
#include "script_api/watchdog.hpp"
#include "state/controller_state.hpp"
#include "urscript/library.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator {

class Arm;
class World;
struct RobotModel;

/// Requests of robot builtins to the controller. They are called on the controller's thread inside
/// Machine::cycle(); the controller must act on them after the cycle.
struct ScriptRequests {
  std::function<void()> power_down;  ///< powerdown()
  std::function<void(const ErrorCode & code, std::string reason)> protective_stop;
};

/// Objects that the robot builtins act on. They must outlive the library.
struct RobotAccess {
  ControllerState & state;
  Arm & arm;
  World & world;
  const RobotModel & model;
  Watchdog & watchdog;
  ScriptRequests requests;
  double cycle_time = 0.002;  ///< s
  /// Recorded by the controller in each cycle after Arm::step(); if null, only the current position is known.
  const JointHistory * history = nullptr;
  /// The value of an RTDE output, or nothing if there is none of this name; null: no program can read them.
  std::function<std::optional<urscript::Value>(std::string_view name)> rtde_value = nullptr;
  /// Shared with the server that receives the statements.
  std::shared_ptr<InterpreterMode> interpreter_mode = std::make_shared<InterpreterMode>();
  PolyscopeVersion version = {5, 25, 1, 0};
};

/// The standard builtins and the robot builtins of URScript. Builtins that the simulator does not model exist
/// by name and fail with "… is not modelled by the simulator yet"; docs/use/urscript.md lists them.
std::shared_ptr<const urscript::Library> make_robot_library(const RobotAccess & access);

}  // namespace ur_simulator
