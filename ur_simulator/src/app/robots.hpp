#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/options.hpp"
#include "app/status_display.hpp"
#include "controller/controller.hpp"

namespace ur_simulator {

/// The addresses of `count` robots: consecutive IPv4 addresses from `first`. Throws std::runtime_error if
/// there are not as many.
std::vector<std::string> consecutive_addresses(const std::string & first, unsigned count);

/// What it means that other hosts can connect to this address; empty for a loopback address.
std::string exposure_warning(const std::string & address);

/// The robots of this process. Each runs in a thread of its own from start() to stop().
class Robots {
 public:
  /// Opens the ports of all robots. Throws std::runtime_error for invalid options and ports that cannot be
  /// bound.
  explicit Robots(const AppOptions & options);
  ~Robots();
  Robots(const Robots &) = delete;
  Robots & operator=(const Robots &) = delete;

  void start();
  void stop();

 private:
  struct Robot {
    std::string address;
    std::unique_ptr<Controller> controller;
    std::thread thread;
  };

  void add(const AppOptions & options, const SimulatorOptions & simulator);
  void print_ready(const AppOptions & options) const;
  /// What was logged while the robots were created.
  void print_warnings() const;

  std::optional<DiagramWriter> client_log_;
  std::vector<Robot> robots_;
  bool shows_status_;
  std::optional<StatusDisplay> status_;
};

}  // namespace ur_simulator
