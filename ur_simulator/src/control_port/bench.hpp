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
#include "safety/safety.hpp"
#include "state/controller_state.hpp"
#include "state/cycle_trace.hpp"
#include "world/world.hpp"

namespace ur_simulator::control_port {

/// What the control port's commands act on. Everything outlives it.
struct Bench {
  ControllerState & state;
  Arm & arm;
  World & world;
  Safety & safety;
  Pendant & pendant;
  EventLog & log;
  rtde::Server & rtde;
  /// "rtde", "dashboard", "primary", "secondary", "realtime".
  std::map<std::string, Listener *> links;
  /// Cycles the host did not run in time since the start.
  const std::uint64_t & missed_cycles;
  const CycleTrace & trace;
  /// Switches the controller off and, after so many s, on.
  std::function<void(double)> reboot;
};

/// The state as the command "state" reports it.
nlohmann::json to_json(const Bench & bench);

}  // namespace ur_simulator::control_port
