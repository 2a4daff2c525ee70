#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "log/event_log.hpp"
#include "motion/arm.hpp"
#include "net/listener.hpp"
#include "polyscope/pendant.hpp"
#include "rtde/server.hpp"
#include "safety/collision_monitor.hpp"
#include "safety/safety.hpp"
#include "state/controller_state.hpp"
#include "state/cycle_trace.hpp"
#include "world/world.hpp"

namespace ur_simulator::control_port {

/// The parts of the simulator that the commands of the control port act on. They outlive the context.
struct ControlPortContext {
  ControllerState & state;
  Arm & arm;
  World & world;
  Safety & safety;
  CollisionMonitor & collisions;
  Pendant & pendant;
  EventLog & log;
  rtde::Server & rtde;
  /// By name: "rtde", "primary", "secondary", "realtime", and the last three with "_read_only"; "dashboard"
  /// or "robot_api", depending on the version; "modbus" if the port is permitted; "robotiq" with the URCap
  /// "robotiq_gripper".
  std::map<std::string, Listener *> listeners;
  /// Number of control cycles that were skipped because the host was too slow.
  const std::uint64_t & missed_cycles;
  const CycleTrace & trace;
  /// Switches the controller off, and on again after the given time, s.
  std::function<void(double duration)> reboot;
};

}  // namespace ur_simulator::control_port
