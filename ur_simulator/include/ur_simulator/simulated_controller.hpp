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

/// TCP ports of a UR controller. 0 selects a free port; SimulatedController::ports() returns it, and 0 for a
/// server that the version does not have. Ports below 1024 need privileges on many hosts: without them,
/// construction fails for `robot_api`, and there is no MODBUS server (ports().modbus is 0).
struct Ports {
  std::uint16_t primary = 30001;
  std::uint16_t secondary = 30002;
  std::uint16_t realtime = 30003;
  std::uint16_t rtde = 30004;
  std::uint16_t primary_read_only = 30011;
  std::uint16_t secondary_read_only = 30012;
  std::uint16_t realtime_read_only = 30013;
  std::uint16_t interpreter = 30020;  ///< interpreter mode, from PolyScope 5.10 on
  std::uint16_t dashboard = 29999;
  std::uint16_t robot_api = 80;   ///< HTTP, PolyScope X from 10.11 on
  std::uint16_t modbus = 502;     ///< MODBUS TCP
  std::uint16_t robotiq = 63352;  ///< socket server of the URCap "robotiq_gripper"
  std::uint16_t control = 30099;  ///< control port of the simulator: JSON lines, see docs/use/simulator.md
};

struct SimulatorOptions {
  std::string address = "127.0.0.1";
  std::string model = "ur10e";  ///< ur3 ur5 ur10 ur3e ur5e ur7e ur10e ur12e ur15 ur16e ur18 ur20 ur30 …
  /// Version 3.x for CB3 models (125 Hz), 5.x or 10.x (PolyScope X) for all others (500 Hz). Empty: 3.15.8 or
  /// 5.25.1.
  std::string polyscope_version;
  Ports ports;
  /// Initial joint positions, rad. Default: tool pointing down in front of the robot.
  std::optional<std::array<double, 6>> initial_joints;
  /// YAML file with the objects around the arm and a time line of events (docs/use/simulator.md). Empty:
  /// none.
  std::string world_file;
  std::vector<std::string> urcaps;  ///< installed URCaps: "onrobot_soft_gripper", "robotiq_gripper"
  /// A pneumatic gripper at the digital outputs of the tool: "single" or "double" acting. Empty: none.
  std::string digital_gripper;
  /// Folder to which the reports and support files of the dashboard are also written. Empty: none.
  std::string reports_folder;
  /// File for a Mermaid sequence diagram of what the clients and the robot do (docs/use/simulator.md, "Client
  /// log").
  /// "-": standard output. Empty: none.
  std::string client_log;
  bool start_running = true;  ///< start powered on with released brakes; false: powered off, as after boot
  bool remote_control = true;
  /// Selects a random calibration of the arm: its kinematics then deviate from the nominal ones by about a
  /// millimeter. 0: nominal kinematics.
  std::uint64_t calibration_seed = 0;
  std::uint64_t seed = 1;  ///< seed of the sensor noise
  /// Simulated seconds per second of the host, 0.01 to 1000. Use values below 1 if the host is too slow for
  /// the control rate, for example with a sanitizer. Beyond what the host can compute, the controller runs as
  /// fast as it can.
  double real_time_factor = 1.0;
  /// Scales the time of power on, brake release, the unlock delay of a protective stop and a restart of the
  /// safety system, 0.01 to 10. Use values below 1 for tests that recover often.
  double recovery_time_factor = 1.0;
  /// Collisions of links with each other and with objects trigger a protective stop.
  bool detect_collisions = true;
  /// Run the controller's thread with SCHED_FIFO if permitted, otherwise with normal priority.
  bool realtime_priority = false;
};

/// A simulated controller that runs in its own thread from construction to destruction. All functions are
/// thread-safe. They must not be called from a condition of wait_until().
///
/// The constructor throws std::runtime_error if a port cannot be bound or an option is invalid. The text
/// states address and port, or the option, its value and the valid values.
class SimulatedController {
 public:
  explicit SimulatedController(const SimulatorOptions & options = {});
  ~SimulatedController();
  SimulatedController(const SimulatedController &) = delete;
  SimulatedController & operator=(const SimulatedController &) = delete;

  const std::string & address() const;
  Ports ports() const;
  /// Executes a request of the control port ({"command": "push", …}) between two control cycles. Returns
  /// {"ok": true, …} or {"ok": false, "error": …}.
  nlohmann::json control(const nlohmann::json & request);
  /// Returns the state after the last control cycle, as the control port's command "state" reports it.
  nlohmann::json state();
  /// Evaluates the condition immediately and after each control cycle, on the controller's thread. Returns
  /// true as soon as the condition is met, false if it is not met within `timeout` of wall-clock time.
  /// Rethrows exceptions of the condition.
  bool wait_until(const std::function<bool(const nlohmann::json & state)> & condition,
                  std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_simulator
