#pragma once

#include <string>
#include <utility>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// Writes log messages. once() logs a lasting condition when it begins and when its text changes.
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
    if (text != last_) {
      last_ = text;
      say(level, text);
    }
  }
  /// Ends the condition: the next once() logs even if the text is the same.
  void forget() { last_.clear(); }

 private:
  LogFunction log_;
  std::string last_;
};

}  // namespace ur_ros_rtde
