#pragma once

#include <chrono>
#include <memory>
#include <rcl_cxx/context.hpp>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

namespace ur_ros_rtde {

/// A node as run_process() runs it.
class Server {
 public:
  virtual ~Server() = default;
  virtual rcl_cxx::Node & node() = 0;
  virtual void start() = 0;
  /// When the process is to end, communication still working: ends what runs, within some seconds. Returns
  /// what could not be ended.
  virtual std::vector<std::string> close() { return {}; }
};

/// How long the goals have to end when the process is to: a stop, and its last means.
constexpr std::chrono::milliseconds close_limit{5000};

}  // namespace ur_ros_rtde
