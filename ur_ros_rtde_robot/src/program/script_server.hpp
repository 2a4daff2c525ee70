#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Serves the control program to the External Control URCap of the robot, which connects, sends the line
/// `request_program` and receives the program until no more data arrives. Listens on all addresses from
/// start() to stop() and retries if the port is not available.
class ScriptServer {
 public:
  /// Called on the server's thread. `version` returns that of the controller, none while unknown. `program`
  /// returns the program for this version, without an enclosing `def`; exceptions are logged.
  struct Source {
    std::function<std::optional<ControllerVersion>()> version;
    std::function<std::string(const ControllerVersion &)> program;
  };

  ScriptServer(std::uint16_t port, std::chrono::milliseconds retry_interval, Source source, LogFunction log);
  ~ScriptServer() { stop(); }
  ScriptServer(const ScriptServer &) = delete;
  ScriptServer & operator=(const ScriptServer &) = delete;

  /// Called on the server's thread when status() has changed. Set before start().
  std::function<void()> status_function;
  void start();
  void stop();

  /// Success while the server listens; else not_ready, with the remedy.
  Status status() const;
  /// Number of times that the program has been fetched.
  unsigned fetched() const;

 private:
  class Service;
  void run(const std::stop_token & stop);
  void set(Status status);
  std::optional<std::string> answer(const std::string & line, const std::string & peer);

  const std::uint16_t port_;
  const std::chrono::milliseconds retry_interval_;
  const Source source_;
  ChangeLogger logger_;
  mutable std::mutex mutex_;
  Status status_;
  unsigned fetched_ = 0;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
