#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/status_text.hpp"
#include "controller/controller.hpp"

namespace ur_simulator {

/// Shows the state of running robots on the standard output, in a thread of its own: on a terminal as lines
/// that are redrawn, otherwise as one line for each change.
class StatusDisplay {
 public:
  struct Robot {
    std::string address;
    Controller * controller;  ///< runs until the display has been destroyed
  };

  explicit StatusDisplay(const std::vector<Robot> & robots);
  ~StatusDisplay();
  StatusDisplay(const StatusDisplay &) = delete;
  StatusDisplay & operator=(const StatusDisplay &) = delete;

 private:
  struct Shown {
    Controller * controller;
    RobotStatus status;
    std::chrono::steady_clock::time_point time;  ///< of the last answer, by the clock of the host
    double simulated_time;                       ///< of the last answer, s
    std::string description;                     ///< printed last
  };

  void run();
  /// Reads the state of the robot. A robot that does not answer keeps its last state.
  static void update(Shown & robot);
  void print_changes();
  void redraw();
  /// Waits until the next update. False: the display ends.
  bool wait();

  const bool terminal_;
  std::vector<Shown> robots_;
  std::size_t drawn_lines_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace ur_simulator
