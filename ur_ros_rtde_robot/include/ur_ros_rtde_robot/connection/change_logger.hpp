#pragma once

#include <string>
#include <utility>

#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// Writes log messages. log_on_change() logs a lasting condition when it begins and when its text changes.
class ChangeLogger {
 public:
  explicit ChangeLogger(LogFunction log) : log_(std::move(log)) {}

  void log(LogLevel level, const std::string & text) const
  {
    if (log_) {
      log_(level, text);
    }
  }
  void log_on_change(LogLevel level, const std::string & text)
  {
    if (text != last_) {
      last_ = text;
      log(level, text);
    }
  }
  /// Ends the condition: the next log_on_change() logs even if the text is the same.
  void reset() { last_.clear(); }

 private:
  LogFunction log_;
  std::string last_;
};

}  // namespace ur_ros_rtde
