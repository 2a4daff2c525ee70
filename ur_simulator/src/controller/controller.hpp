#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "control_port/bench.hpp"
#include "control_port/server.hpp"
#include "dashboard/server.hpp"
#include "kinematics/robot_model.hpp"
#include "log/event_log.hpp"
#include "motion/arm.hpp"
#include "polyscope/pendant.hpp"
#include "polyscope/program_runner.hpp"
#include "primary/realtime_packet.hpp"
#include "primary/script_server.hpp"
#include "rtde/server.hpp"
#include "safety/safety.hpp"
#include "script_api/robot_library.hpp"
#include "state/controller_state.hpp"
#include "ur_simulator/simulated_controller.hpp"
#include "world/world.hpp"

namespace ur_simulator {

/// The whole controller. Everything happens on the thread that calls run(): between two control cycles the
/// sockets are served, so nothing in here needs a lock.
class Controller {
 public:
  /// Called after a cycle; removed when it returns true.
  using Observer = std::function<bool()>;

  explicit Controller(const SimulatorOptions & options);
  Controller(const Controller &) = delete;
  Controller & operator=(const Controller &) = delete;

  /// Returns after stop().
  void run();
  /// From any thread.
  void stop();

  boost::asio::io_context & io() { return io_; }
  Ports ports() const;
  EventLog & log() { return log_; }
  /// On the controller's thread only.
  nlohmann::json control(const nlohmann::json & request);
  nlohmann::json state() const { return control_port::to_json(bench_); }
  void observe(Observer observer) { observers_.push_back(std::move(observer)); }

 private:
  void wait_for_next_cycle();
  void keep_pace();
  void cycle();
  void step_robot();
  void obey(const SafetyOrders & orders);
  void take_safety_events();
  void act_on_requests();
  void publish();
  void reboot(double duration);
  void power_switch(bool on);

  RobotAccess access();
  std::shared_ptr<const urscript::Library> library();
  ProgramAccess program_access();

  const RobotModel & model_;
  PolyscopeVersion version_;
  SimulatorOptions options_;
  std::chrono::steady_clock::duration period_;
  Vector6 initial_joints_;

  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_};
  std::chrono::steady_clock::time_point deadline_;
  std::uint64_t missed_cycles_ = 0;
  bool stopping_ = false;
  std::optional<double> boots_at_;  ///< while switched off: timestamp at which it comes back

  EventLog log_;
  ControllerState state_;
  CycleTrace trace_;
  std::optional<Arm> arm_;
  std::optional<World> world_;
  std::optional<Safety> safety_;
  Watchdog watchdog_;
  JointHistory joint_history_;
  struct Requests {
    bool power_down = false;
    bool protective_stop = false;
  } requests_;
  std::optional<ProgramRunner> runner_;
  std::optional<Pendant> pendant_;

  primary::ScriptServer primary_;
  primary::ScriptServer secondary_;
  primary::ScriptServer realtime_;
  primary::RealtimePacket realtime_packet_;
  rtde::Server rtde_;
  dashboard::Server dashboard_;
  control_port::Bench bench_;
  control_port::Server control_;
  std::list<Observer> observers_;
};

}  // namespace ur_simulator
