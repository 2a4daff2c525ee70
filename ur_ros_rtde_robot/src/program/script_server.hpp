#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/reporter.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Where the External Control URCap of the robot finds the control program: it connects, sends the line
/// `request_program` and takes what comes as its program, until nothing comes any more. Listens on all
/// addresses from start() to stop(), and tries again while it cannot.
class ScriptServer {
 public:
  /// Both are called on the server's thread. `version`: of the controller that asks, none as long as it is
  /// not known. `program`: for it, without a `def` around it; what it throws is logged.
  struct Source {
    std::function<std::optional<ControllerVersion>()> version;
    std::function<std::string(const ControllerVersion &)> program;
  };

  ScriptServer(std::uint16_t port, std::chrono::milliseconds retry_interval, Source source, LogFunction log);
  ~ScriptServer() { stop(); }
  ScriptServer(const ScriptServer &) = delete;
  ScriptServer & operator=(const ScriptServer &) = delete;

  std::function<void()> status_function;  ///< when status() has changed, on the server's thread; set before
  void start();
  void stop();

  /// Success while it listens; else not_ready, with the way out.
  Status status() const;
  /// How often the program has been fetched.
  unsigned fetched() const;

 private:
  class Service;
  void run(const std::stop_token & stop);
  void set(Status status);
  std::optional<std::string> answer(const std::string & line, const std::string & peer);

  const std::uint16_t port_;
  const std::chrono::milliseconds retry_interval_;
  const Source source_;
  Reporter report_;
  mutable std::mutex mutex_;
  Status status_;
  unsigned fetched_ = 0;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
