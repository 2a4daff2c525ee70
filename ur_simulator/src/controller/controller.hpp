#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "client_log/client_log.hpp"
#include "control_port/commands.hpp"
#include "control_port/server.hpp"
#include "dashboard/server.hpp"
#include "kinematics/robot_model.hpp"
#include "log/event_log.hpp"
#include "modbus/server.hpp"
#include "motion/arm.hpp"
#include "polyscope/pendant.hpp"
#include "polyscope/program_runner.hpp"
#include "primary/client_interface_server.hpp"
#include "primary/global_variables.hpp"
#include "primary/interpreter_server.hpp"
#include "primary/realtime_packet.hpp"
#include "robot_api/server.hpp"
#include "rtde/server.hpp"
#include "safety/collision_monitor.hpp"
#include "safety/safety.hpp"
#include "script_api/robot_library.hpp"
#include "state/controller_state.hpp"
#include "ur_simulator/simulated_controller.hpp"
#include "urcap/robotiq_server.hpp"
#include "world/joint_sensors.hpp"
#include "world/world.hpp"
#include "world_file/event_timeline.hpp"

namespace ur_simulator {

/// The simulated controller: the robot, its software and its servers. All work is done on the thread that
/// calls run(): it executes the control cycles and serves the connections in between, so that no locks are
/// required.
class Controller {
 public:
  /// Called after each control cycle until it returns true.
  using Observer = std::function<bool()>;

  /// Opens the ports. Throws std::runtime_error for invalid options and ports that cannot be bound.
  explicit Controller(const SimulatorOptions & options);
  Controller(const Controller &) = delete;
  Controller & operator=(const Controller &) = delete;

  /// Runs the controller until stop() is called.
  void run();
  /// Thread-safe.
  void stop();

  /// Runs the function on the controller's thread, between two control cycles. Thread-safe.
  template <typename Function>
  auto call(Function function)
  {
    auto task = std::make_shared<std::packaged_task<decltype(function())()>>(std::move(function));
    auto result = task->get_future();
    boost::asio::post(io_, [task] { (*task)(); });
    return result;
  }
  Ports ports() const;

  // The functions below must be called on the controller's thread, or while run() is not running.

  EventLog & log() { return log_; }
  /// Executes a request of the control port.
  nlohmann::json control(const nlohmann::json & request);
  nlohmann::json state() const { return control_port::state_to_json(control_port_context_); }
  void add_observer(Observer observer) { observers_.push_back(std::move(observer)); }
  /// Adds what this robot and its clients do to the diagram, from now on. `robot_name`: "" if it is the only
  /// robot of the diagram.
  void start_client_log(DiagramWriter & writer, const std::string & robot_name);

 private:
  /// Requests of the program, handled after its cycle.
  struct ScriptRequestFlags {
    bool power_down = false;
    std::optional<ErrorCode> protective_stop;
    std::string stop_reason;
  };

  RobotAccess robot_access();
  std::shared_ptr<const urscript::Library> script_library();
  ProgramContext program_context();
  std::unique_ptr<dashboard::Server> open_dashboard_server();
  std::unique_ptr<robot_api::Server> open_robot_api();
  std::unique_ptr<urcap::RobotiqServer> open_robotiq_server();
  std::unique_ptr<primary::InterpreterServer> open_interpreter_server();
  std::unique_ptr<modbus::Server> open_modbus_server();
  control_port::ControlPortContext control_port_context();
  std::map<std::string, Listener *> listeners();
  /// Places the objects of the world file, and returns its events.
  EventTimeline load_world_file();

  void schedule_next_cycle();
  void run_due_cycles();
  void run_cycle();
  void run_robot_cycle();
  void check_watchdog();
  void check_collisions();
  void handle_script_requests();
  void apply_safety_actions(const SafetyActions & actions);
  void log_safety_events();
  void publish_state();
  void publish_robot_state();
  void publish_global_variables();
  /// The first messages to a client of the primary interface.
  std::string primary_greeting() const;
  /// Sends a message to the clients of an interface and of its read-only variant.
  static void broadcast(primary::ClientInterfaceServer & server, primary::ClientInterfaceServer & read_only,
                        std::string_view message, std::string_view name = {});
  /// Reports an entry of the log to the clients of the primary interface, and in the client log.
  void report(const LogEntry & entry);
  void request_program(const ProgramHost & host, std::function<void(const Pendant::ProgramText &)> done);
  /// A host that the robot connects to.
  PeerLog add_host();
  void handle_data_package(std::span<const rtde::InputField * const> fields);

  void switch_on();
  void switch_off();
  void reboot(double duration);

  const RobotModel model_;
  PolyscopeVersion version_;
  SimulatorOptions options_;
  std::chrono::steady_clock::duration period_;  ///< duration of a control cycle on the host's clock
  Vector6 initial_joints_;

  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_};
  std::chrono::steady_clock::time_point next_cycle_;
  std::uint64_t missed_cycles_ = 0;
  bool stopping_ = false;
  std::optional<double> switch_on_time_;  ///< set while switched off, s of simulated time

  EventLog log_;
  ControllerState state_;
  std::optional<ClientLog> client_log_;
  CycleTrace trace_;
  std::optional<Arm> arm_;
  JointSensors joint_sensors_;
  std::optional<World> world_;
  std::optional<Safety> safety_;
  CollisionMonitor collisions_;
  Watchdog watchdog_;
  JointHistory joint_history_;
  std::shared_ptr<InterpreterMode> interpreter_mode_ = std::make_shared<InterpreterMode>();
  ScriptRequestFlags script_requests_;
  std::optional<ProgramRunner> runner_;
  std::optional<Pendant> pendant_;

  primary::GlobalVariables global_variables_;
  primary::ClientInterfaceServer primary_;
  primary::ClientInterfaceServer secondary_;
  primary::ClientInterfaceServer realtime_;
  primary::ClientInterfaceServer primary_read_only_;
  primary::ClientInterfaceServer secondary_read_only_;
  primary::ClientInterfaceServer realtime_read_only_;
  std::unique_ptr<primary::InterpreterServer> interpreter_;  ///< null: the version has no interpreter mode
  primary::RealtimePacket realtime_packet_;
  rtde::Server rtde_;
  std::unique_ptr<dashboard::Server> dashboard_;   ///< null: PolyScope X
  std::unique_ptr<robot_api::Server> robot_api_;   ///< null: the version has none
  std::unique_ptr<urcap::RobotiqServer> robotiq_;  ///< null: the URCap is not installed
  std::unique_ptr<modbus::Server> modbus_;         ///< null: the port is not permitted
  control_port::ControlPortContext control_port_context_;
  control_port::Server control_port_;
  EventTimeline event_timeline_;
  std::list<Observer> observers_;
};

}  // namespace ur_simulator
