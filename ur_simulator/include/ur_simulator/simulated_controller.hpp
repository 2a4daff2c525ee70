#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

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
  std::string model = "ur10e";  ///< ur3 ur5 ur10 ur3e ur5e ur7e ur10e ur12e ur15 ur16e ur18 ur20 ur30 …
  /// "3.15.8" for a CB3 controller (125 Hz), 5.x for the others (500 Hz); empty: 5.25.1, or 3.15.8 for CB3
  /// models.
  std::string polyscope_version;
  Ports ports;
  /// Where the joints stand at first, rad; nothing: tool down above the table in front of the robot.
  std::optional<std::array<double, 6>> initial_joints;
  std::vector<std::string> urcaps;  ///< what is installed: "onrobot_soft_gripper"
  /// Where the dashboard's reports and support files are written too; empty: they stay on the simulated disk.
  std::string reports_folder;
  bool start_running = true;  ///< powered on, brakes released; false: power off, as after boot
  bool remote_control = true;
  std::uint64_t seed = 1;  ///< of the sensor noise
  /// Seconds of the robot for each of the host's, 0.01 to 10. Below 1 for a host that is too slow for the
  /// controller's rate, such as one that runs programs with a sanitizer.
  double real_time_factor = 1.0;
  /// Scales how long power on, brake release, the unlock delay of a protective stop and a restart of the
  /// safety system take, 0.01 to 10. Below 1 for tests that recover often.
  double recovery_time_factor = 1.0;
  bool realtime_priority =
      false;  ///< try SCHED_FIFO for the controller's thread; goes on without when not permitted
};

/// A simulated controller that runs in a thread of its own, from construction to destruction. All methods are
/// thread-safe and must not be called from a condition of wait_until().
///
/// The constructor throws std::runtime_error: address and port when a port cannot be bound, the known ones
/// when model or version are unknown, value and limit when joints or the real-time factor are out of range.
class SimulatedController {
 public:
  explicit SimulatedController(const SimulatorOptions & options = {});
  ~SimulatedController();
  SimulatedController(const SimulatedController &) = delete;
  SimulatedController & operator=(const SimulatedController &) = delete;

  const std::string & address() const;
  Ports ports() const;
  /// One request of the control port ({"command": "push", …}), answered in the same JSON: {"ok": true, …} or
  /// {"ok": false, "error": …}. Carried out between two cycles.
  nlohmann::json control(const nlohmann::json & request);
  /// The state after the last cycle, as the control port's "state" reports it.
  nlohmann::json state();
  /// Evaluates the condition on the state now and after every further control cycle, on the controller's
  /// thread; true as soon as it holds, false when it has not become true within `limit` of wall-clock time.
  /// What it throws is thrown here.
  bool wait_until(const std::function<bool(const nlohmann::json & state)> & condition,
                  std::chrono::milliseconds limit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
