#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

struct CommandDescription;

/// What a Run needs of the goal or the teleoperation session that it belongs to.
struct RunContext {
  Robot & robot;
  std::shared_ptr<const StopRequest> stop_request;
  Lease * lease = nullptr;                       ///< null: it does not move the arm
  const CommandDescription * command = nullptr;  ///< null: teleoperation
  int depth = 0;                                 ///< of calls by other commands
  /// Of a stop: it has begun already.
  std::optional<std::shared_future<Expected<StopReport>>> stopping{};
  /// Of a stop: the goal that was executed, "/move_j, goal 3f0c12ab". Empty: none.
  std::string preempted_goal{};
  std::uint32_t stops_before = 0;  ///< CommandHost::stops() when the goal was received
  /// How the arm is stopped from now on if the goal has to end. Returns how it was until now.
  std::function<StopOptions(const StopOptions &)> exchange_stop_options = [](const StopOptions & options) {
    return options;
  };
  /// How the arm is stopped if the goal has to end.
  std::function<StopOptions()> stop_options = [] { return StopOptions{}; };
  std::function<void(const std::string &)> log_warning = [](const std::string &) {};
  /// Publishes an A::Feedback of the action.
  std::function<void(const void *)> publish_feedback = [](const void *) {};
};

}  // namespace ur_ros_rtde
