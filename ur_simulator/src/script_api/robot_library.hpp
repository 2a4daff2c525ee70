#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/types.hpp"
#include "state/controller_state.hpp"
#include "urscript/library.hpp"

namespace ur_simulator {

class Arm;
class World;
struct RobotModel;

/// rtde_set_watchdog(): while a program runs that set it, a variable that no RTDE client writes for
/// 1/frequency s triggers the action. The RTDE server calls `fed` for every data package that contains the
/// variable; the controller asks `expired` each cycle.
class Watchdog {
 public:
  enum class Action : std::uint8_t { ignore, pause, stop };

  void set(const std::string & variable, double minimum_frequency, Action action, double now);
  /// A data package with this variable arrived at `now` (s, ControllerState::timestamp).
  void fed(const std::string & variable, double now);
  /// The program ended: its watchdogs end with it.
  void clear();
  /// The action of the first watchdog that ran out; it is reported once and re-armed by the next package.
  std::optional<Action> expired(double now);

 private:
  struct Entry {
    std::string variable;
    double period;
    Action action;
    double last;
    bool reported;
  };
  std::vector<Entry> entries_;
};

/// The joint positions of the last cycles, for get_actual_joint_positions_history(). The controller records
/// once a cycle.
class JointHistory {
 public:
  static constexpr std::size_t capacity = 1024;

  void record(const Vector6 & position);
  /// `steps` cycles ago (0: the last recorded); nothing when it is not that long.
  std::optional<Vector6> back(std::size_t steps) const;

 private:
  std::array<Vector6, capacity> positions_{};
  std::size_t count_ = 0;
};

/// What robot builtins ask of the controller as a whole. Called on the controller's thread, from inside
/// Machine::cycle(): remember the request and act after the cycle.
struct ScriptRequests {
  std::function<void()> power_down;       ///< powerdown()
  std::function<void()> protective_stop;  ///< protective_stop()
};

/// Where the robot builtins act. Everything outlives the library.
struct RobotAccess {
  ControllerState & state;
  Arm & arm;
  World & world;
  const RobotModel & model;
  Watchdog & watchdog;
  ScriptRequests requests;
  double cycle_time = 0.002;  ///< s
  /// Recorded by the controller each cycle after Arm::step; without it only the present position is known.
  const JointHistory * history = nullptr;
};

/// The standard builtins and everything URScript offers of a robot, as far as it is modelled; the rest exists
/// by name and fails with "… is not modelled by the simulator yet". See docs/urscript.md for the table.
std::shared_ptr<const urscript::Library> make_robot_library(const RobotAccess & access);

}  // namespace ur_simulator
