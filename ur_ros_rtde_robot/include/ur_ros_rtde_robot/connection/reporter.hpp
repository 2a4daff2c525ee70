#pragma once

#include <string>
#include <utility>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// Logs, and logs a condition that lasts only once: when it begins, and when its text changes.
class Reporter {
 public:
  explicit Reporter(LogFunction log) : log_(std::move(log)) {}

  void say(LogLevel level, const std::string & text) const
  {
    if (log_) {
      log_(level, text);
    }
  }
  void once(LogLevel level, const std::string & text)
  {
    if (text != said_) {
      said_ = text;
      say(level, text);
    }
  }
  /// The condition is over: the next `once` is said even if its text is the same.
  void forget() { said_.clear(); }

 private:
  LogFunction log_;
  std::string said_;
};

}  // namespace ur_ros_rtde
