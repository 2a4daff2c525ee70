#pragma once

#include <functional>
#include <memory>
#include <rcl_cxx/goal_response.hpp>
#include <rcl_cxx/goal_uuid.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/command_traits.hpp"
#include "ur_ros_rtde/detail/active_goals.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The part of Command<A> that does not depend on the type of the action: acceptance, arbitration, and the
/// standstill at the end of a goal.
class CommandExecutor {
 public:
  /// `action` is the resolved name. `extension` is the plugin's name if it is an extension, otherwise empty.
  CommandExecutor(CommandHost & host, std::string action, const CommandTraits & traits,
                  std::string extension);

  CommandHost & host() { return host_; }
  ActiveGoals & goals() { return goals_; }
  bool moves_arm() const
  {
    return traits_.resource == Resource::motion || traits_.resource == Resource::script;
  }
  /// A goal ends when the robot cannot move any more.
  bool needs_motion() const { return moves_arm() && !traits_.allowed_in_any_state; }
  /// A goal is stopped when its client disappears. The goals of a stop are not.
  bool stops_when_client_lost() const
  {
    return host_.options().stop_when_client_lost && !traits_.preempts_all;
  }

  /// Calls `check`. If it queries the robot, the response is deferred, and a thread of its own waits for the
  /// answers.
  rcl_cxx::GoalDecision accept(const rcl_cxx::GoalUUID & id, const std::function<void(Check &)> & check);
  /// Acquires the resource, calls `body`, and brings the arm to a standstill if `body` has not. `body` and
  /// `stop_options` may throw. If `stop_options` throws, `body` is not called and the default options apply.
  Outcome execute(const rcl_cxx::GoalUUID & id, GoalContext & context,
                  const std::function<StopOptions()> & stop_options, const std::function<Outcome()> & body);

 private:
  class RobotPreflight;

  void start_queries(const rcl_cxx::GoalUUID & id, std::vector<RobotQuery> queries,
                     rcl_cxx::SendGoalResponse respond);
  Outcome run_queries(const std::vector<RobotQuery> & queries, const StopRequest & stop_request) const;

  Claim claim(const rcl_cxx::GoalUUID & id, GoalContext & context) const;
  /// Success if the state of the robot allows a goal.
  Status check_state() const;
  /// The goal that holds the resource will be preempted when the new goal starts.
  bool preempts() const;
  Status acquire(const rcl_cxx::GoalUUID & id, GoalContext & context, const StopOptions & stop);
  Outcome bring_to_standstill(const Outcome & outcome, StopOptions stop);

  CommandHost & host_;
  const CommandTraits traits_;
  const std::string extension_;
  ActiveGoals goals_;
};

}  // namespace ur_ros_rtde
