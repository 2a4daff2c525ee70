#pragma once

#include <memory>
#include <string>

#include "ur_ros_rtde/command_traits.hpp"
#include "ur_ros_rtde/detail/command_executor.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/plugin.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The part of Command<A> that does not depend on the type of the action: a goal on its way through a
/// CommandExecutor.
class CommandBase : public CommandPlugin, private GoalServer {
 public:
  /// How goals share the robot with the goals of other commands. Asked once.
  virtual CommandTraits traits() const { return {}; }

  void start_action_server(CommandHost & host, const std::string & name) override;
  void stop_action_server() override { stop_server(); }

 private:
  virtual const rcl_cxx::ActionType & action_type() const = 0;
  virtual void check_goal(const void * goal, Check & check) const = 0;
  virtual StopOptions stop_options_of(const void * goal) const = 0;
  virtual std::unique_ptr<Run> make_run(Robot & robot, std::shared_ptr<StopRequest> stop_request, bool moves,
                                        PublishFeedback publish) const = 0;
  virtual Outcome run_goal(const void * goal, Run & run) = 0;

  rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const void * goal) override;
  void execute_goal(Handle & handle, GoalContext & context) override;
  void abort_unstarted(Handle & handle, const Outcome & outcome) override;

  std::string name_;
  std::unique_ptr<CommandExecutor> executor_;
};

}  // namespace ur_ros_rtde
