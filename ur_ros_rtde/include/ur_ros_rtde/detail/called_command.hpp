#pragma once

#include <functional>
#include <stop_token>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/detail/command_goal.hpp"
#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// A goal of a command that is executed as a part of another command's goal, without its types; see
/// Run::call().
struct CalledCommand {
  const CommandDescription & description;
  std::function<Status(const std::stop_token &)> resolve_frame;
  std::function<void(Check &)> check;
  std::function<StopOptions()> stop_options;
  std::function<Outcome(const RunContext &)> run;
};

/// Why `command` cannot be called; `exists`: there is one of that name, with another action.
Error not_callable(const std::string & command, bool exists);

}  // namespace ur_ros_rtde
