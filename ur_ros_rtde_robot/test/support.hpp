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

/// An address in 127.0.0.0/8 that belongs to the running test alone, so that tests run in parallel.
std::string own_address();

/// Waits for a condition; false when it has not come true within `limit`.
bool eventually(const std::function<bool()> & condition, std::chrono::milliseconds limit = 5s);

/// A controller on the test's address, or none yet.
class Controller {
 public:
  Controller() = default;
  explicit Controller(const ur_simulator::SimulatorOptions & options) { start(options); }
  static ur_simulator::SimulatorOptions options();

  void start(const ur_simulator::SimulatorOptions & options = Controller::options());
  void stop() { controller_.reset(); }
  /// Fails the test when the simulator refuses.
  nlohmann::json control(const nlohmann::json & request);
  nlohmann::json state() { return controller_->state(); }

 private:
  std::unique_ptr<ur_simulator::SimulatedController> controller_;
};

/// Keeps what was logged.
class Log {
 public:
  LogFunction function();
  std::size_t count(const std::string & part) const;
  std::string text() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// A server that accepts connections and answers each with `reply`, whatever it is sent.
class OtherService {
 public:
  OtherService(std::uint16_t port, std::string reply);
  ~OtherService();

 private:
  int listener_ = -1;
  std::string reply_;
  std::jthread thread_;
};

std::size_t open_descriptors();
std::size_t running_threads();

/// Patient with a host on which many tests run at once; tests of the limits set them to what they are by
/// default.
RobotOptions robot_options();
StateReceiverOptions receiver_options();

}  // namespace ur_ros_rtde::test
