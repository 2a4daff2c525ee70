#pragma once

#include <cstdint>
#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>

#include "ur_ros_rtde/detail/active_goals.hpp"

namespace ur_ros_rtde {

/// An action server that executes each accepted goal in a thread of its own and sends exactly one result. It
/// is compiled once for all actions: `goal` and `result` are an A::Goal and an A::Result of the action.
class GoalServer {
 protected:
  using Handle = rcl_cxx::ServerGoalHandle;

  GoalServer() = default;
  virtual ~GoalServer() = default;

  /// `goals` outlives the server. If `stop_when_client_lost`, a goal is stopped when the client that sent it
  /// disappears.
  void start_server(rcl_cxx::Node & node, const rcl_cxx::ActionType & type, const std::string & name,
                    ActiveGoals & goals, bool stop_when_client_lost);
  void stop_server() { server_.reset(); }
  /// Sends the goal's only result, with the outcome filled in.
  void finish(Handle & handle, void * result, const Outcome & outcome);

 private:
  /// Runs in the executor's thread and must not wait.
  virtual rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const void * goal) = 0;
  /// Runs in the goal's thread and ends with finish().
  virtual void execute_goal(Handle & handle, GoalContext & context) = 0;
  /// Called for an accepted goal for which no thread could be started. Ends with finish().
  virtual void abort_unstarted(Handle & handle, const Outcome & outcome) = 0;
  /// Writes the outcome into the result. May throw.
  virtual void write_outcome(const Outcome & outcome, void * result) const = 0;
  /// Does the same after write_outcome() has thrown, for the fields that every result has.
  virtual void write_failure(const Outcome & outcome, void * result) const = 0;

  void start_goal(const std::shared_ptr<Handle> & handle);
  /// write_outcome(). If it throws, the exception is the outcome.
  Outcome write_outcome_guarded(const Outcome & outcome, void * result) const;

  ActiveGoals * goals_ = nullptr;
  rcl_cxx::ActionServer::SharedPtr server_;
};

/// Writes the outcome into `bool success, uint16 error_code, string message`, if the result begins with them.
template <typename Result>
void write_standard_fields(const Outcome & outcome, Result & result)
{
  if constexpr (requires { result.success; }) {
    result.success = static_cast<bool>(outcome);
    result.error_code = static_cast<std::uint16_t>(outcome.code());
    result.message = outcome.message();
  }
}

}  // namespace ur_ros_rtde
