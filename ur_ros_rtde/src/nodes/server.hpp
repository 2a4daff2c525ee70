#pragma once

#include <chrono>
#include <memory>
#include <rcl_cxx/context.hpp>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// A node that run_process() runs.
class Server {
 public:
  virtual ~Server() = default;
  virtual rcl_cxx::Node & node() = 0;
  virtual void start() = 0;
  /// Called at shutdown while communication still works. Stops all goals within close_limit. Returns the
  /// names of those that did not end.
  virtual std::vector<std::string> close() { return {}; }
};

/// Time for the goals to end at shutdown: a stop, including its fallbacks.
constexpr std::chrono::milliseconds close_limit{5000};

}  // namespace ur_ros_rtde
