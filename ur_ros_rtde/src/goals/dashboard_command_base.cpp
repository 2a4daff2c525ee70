#include "ur_ros_rtde/detail/dashboard_command_base.hpp"

#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {
namespace {

Status dashboard_ready(const DashboardConnection & connection)
{
  const LinkStatus status = connection.link();
  if (status.connected) {
    return {};
  }
  return failure(ErrorCode::link_lost, status.error.message.empty()
                                           ? std::string("not yet connected to the dashboard server")
                                           : status.error.message);
}

}  // namespace

void DashboardCommandBase::start_action_server(DashboardHost & host, const std::string & name)
{
  connection_ = &host.connection();
  goals_ = std::make_unique<ActiveGoals>(host, host.node().resolve_service_name(name));
  start_server(host.node(), action_type(), name, *goals_, false);
}

rcl_cxx::GoalDecision DashboardCommandBase::accept_goal(const rcl_cxx::GoalUUID & id, const void * goal)
{
  return goals_->accept(id, [&](GoalContext &) -> Status {
    Check check;
    check_goal(goal, check);
    if (!check.ok()) {
      return tl::unexpected(*check.error());
    }
    const Status ready = dashboard_ready(*connection_);
    return ready ? supported(goals_->action(), limits(), *connection_) : ready;
  });
}

void DashboardCommandBase::execute_goal(Handle & handle, GoalContext & context)
{
  const auto run = make_run(*connection_, context.stop_request,
                            [&handle](const void * feedback) { handle.publish_feedback(feedback); });
  const Outcome outcome = guarded(*context.stop_request, [&] { return run_goal(handle.get_goal(), *run); });
  finish(handle, run->finish_result(), outcome);
}

void DashboardCommandBase::abort_unstarted(Handle & handle, const Outcome & outcome)
{
  const auto run = make_run(*connection_, std::make_shared<StopRequest>(), {});
  finish(handle, run->finish_result(), outcome);
}

}  // namespace ur_ros_rtde
