#include "ur_ros_rtde/detail/command_base.hpp"

namespace ur_ros_rtde {

void CommandBase::start_action_server(CommandHost & host, const std::string & name)
{
  name_ = name;
  executor_ = std::make_unique<CommandExecutor>(host, host.node().resolve_service_name(name), traits(),
                                                script_extension() ? name : std::string());
  start_server(host.node(), action_type(), name, executor_->goals(), executor_->stops_when_client_lost());
}

rcl_cxx::GoalDecision CommandBase::accept_goal(const rcl_cxx::GoalUUID & id, const void * goal)
{
  return executor_->accept(id, [&](Check & check) { check_goal(goal, check); });
}

void CommandBase::execute_goal(Handle & handle, GoalContext & context)
{
  const auto run = make_run(executor_->host().robot(), context.stop_request, executor_->needs_motion(),
                            [&handle](const void * feedback) { handle.publish_feedback(feedback); });
  run->on_warning([&](const std::string & text) { executor_->goals().warn(handle.get_goal_id(), text); });
  const auto stop = [&] { return stop_options_of(handle.get_goal()); };
  const Outcome outcome = executor_->execute(handle.get_goal_id(), context, stop, [&] {
    run->set_preempted_goal(context.preempted_goal);
    run->set_plugin(name_);
    return run_goal(handle.get_goal(), *run);
  });
  finish(handle, run->finish_result(), run->with_warnings(outcome));
}

void CommandBase::abort_unstarted(Handle & handle, const Outcome & outcome)
{
  const auto run = make_run(executor_->host().robot(), std::make_shared<StopRequest>(), false, {});
  finish(handle, run->finish_result(), outcome);
}

}  // namespace ur_ros_rtde
