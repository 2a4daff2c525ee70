#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <ur_simulator/simulated_controller.hpp>
#include <vector>

#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde::test {

using namespace std::chrono_literals;

/// An address in 127.0.0.0/8 that is unique to the running test, so that tests can run in parallel.
std::string own_address();

/// A port on which no process listens.
std::uint16_t free_port();

/// Waits for a condition; false if it does not hold within `timeout`.
bool eventually(const std::function<bool()> & condition, std::chrono::milliseconds timeout = 15s);

/// A simulated controller at the test's address; initially none.
class Controller {
 public:
  Controller() = default;
  explicit Controller(const ur_simulator::SimulatorOptions & options) { start(options); }
  static ur_simulator::SimulatorOptions options();
  /// The same of a robot whose time passes at a tenth of the speed, so that delays of a busy host are short
  /// in its time.
  static ur_simulator::SimulatorOptions slow_options();

  void start(const ur_simulator::SimulatorOptions & options = Controller::options());
  void stop() { controller_.reset(); }
  /// Sends a request to the control port; the test fails if the simulator rejects it.
  nlohmann::json control(const nlohmann::json & request);
  /// Of an operator: `other`, which does not end by itself.
  void run_other_program();
  nlohmann::json state() { return controller_->state(); }

 private:
  std::unique_ptr<ur_simulator::SimulatedController> controller_;
};

/// Records log messages.
class Log {
 public:
  LogFunction function();
  std::size_t count(const std::string & part) const;
  std::string text() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// A server that sends `reply` on each connection and ignores its input.
class OtherService {
 public:
  /// With `listens_first`, it replies to the first line only.
  OtherService(std::uint16_t port, std::string reply, bool listens_first = false);
  ~OtherService();

 private:
  int listener_ = -1;
  std::string reply_;
  std::jthread thread_;
};

std::size_t open_descriptors();
std::size_t running_threads();

/// Options with time limits for a host that runs many tests in parallel. Tests of these limits use the
/// defaults.
RobotOptions robot_options();
StateReceiverOptions receiver_options();

}  // namespace ur_ros_rtde::test
