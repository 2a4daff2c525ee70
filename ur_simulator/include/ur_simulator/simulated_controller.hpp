#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

namespace ur_simulator {

/// The ports of a UR controller; 0 takes a free one (read back with SimulatedController::ports()).
struct Ports {
  std::uint16_t primary = 30001;
  std::uint16_t secondary = 30002;
  std::uint16_t realtime = 30003;
  std::uint16_t rtde = 30004;
  std::uint16_t dashboard = 29999;
  std::uint16_t control = 30099;  ///< ours: JSON lines, see docs/simulator.md
};

struct SimulatorOptions {
  std::string address = "127.0.0.1";
  std::string model = "ur10e";             ///< ur3 ur5 ur10 ur3e ur5e ur7e ur10e ur12e ur15 ur16e ur18 ur20 ur30 …
  std::string polyscope_version = "5.25.1";  ///< "3.15.8" makes a CB3 controller (125 Hz)
  Ports ports;
  bool start_running = true;   ///< powered on, brakes released; false: power off, as after boot
  bool remote_control = true;
  std::uint64_t seed = 1;      ///< of the sensor noise
};

/// A simulated controller that runs in a thread of its own, from construction to destruction. All methods are thread-safe.
/// Throws std::runtime_error naming address and port when a port cannot be bound.
class SimulatedController {
 public:
  explicit SimulatedController(const SimulatorOptions & options = {});
  ~SimulatedController();
  SimulatedController(const SimulatedController &) = delete;
  SimulatedController & operator=(const SimulatedController &) = delete;

  Ports ports() const;
  /// One request of the control port ({"command": "push", …}), answered in the same JSON: {"ok": true, …} or {"ok": false, "error": …}.
  nlohmann::json control(const nlohmann::json & request);
  /// The state after the last cycle, as the control port's "state" reports it.
  nlohmann::json state();
  /// Evaluated after every control cycle on the controller's thread with the state in JSON only when `every_cycles` have passed;
  /// returns whether it became true within `limit` of wall-clock time.
  bool wait_until(const std::function<bool(const nlohmann::json &)> & condition, std::chrono::milliseconds limit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
