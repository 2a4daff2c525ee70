#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace rcl_cxx {
class CallbackGroup;
class Node;
}  // namespace rcl_cxx

namespace ur_ros_rtde {

/// A node that run_process() runs.
class Server {
 public:
  virtual ~Server() = default;
  virtual rcl_cxx::Node & node() = 0;
  /// The callbacks that must not wait for those of the node. Each group gets a thread of its own.
  virtual std::vector<const rcl_cxx::CallbackGroup *> groups() { return {}; }
  /// Called in this order, the first one before the node has an executor. Neither affects the robot.
  virtual void load_plugins() {}
  virtual void create_actions() {}
  /// Connects to the robot. Runs after load_plugins(), concurrently with create_actions().
  virtual void start() = 0;
  /// Called at shutdown while communication still works: tells all goals to end, which stops the arm. Returns
  /// at once: a goal of another node may hang.
  virtual void end_goals() {}
  /// Called after that. Waits for the goals, at most close_timeout. Returns the names of those that did not
  /// end.
  virtual std::vector<std::string> close() { return {}; }
};

/// In the order of their start. Destroyed in reverse order.
using Servers = std::vector<std::unique_ptr<Server>>;

/// Ends the process if `goals`, the result of Server::close(), is not empty: their threads cannot be joined,
/// and objects that they use must not be destroyed. The watchdog of the control program stops the arm.
void exit_without(const std::vector<std::string> & goals, const rcl_cxx::Node & node);

/// Why goals end at shutdown.
inline Error shutdown_error()
{
  return {ErrorCode::shutdown, "the node is being shut down"};
}

/// Time for the goals to end at shutdown: a stop, including its fallbacks.
constexpr std::chrono::milliseconds close_timeout{5000};

}  // namespace ur_ros_rtde
