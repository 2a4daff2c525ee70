#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_text.hpp>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/dashboard_run.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

/// Success if the dashboard server is connected.
Status dashboard_ready(const DashboardConnection & link);
/// Fails unless `text` is one of `texts`. Every text is allowed if `texts` is empty.
void check_text(const std::string & text, const std::vector<std::string> & texts, Check & check);

/// Base class of a command to the dashboard server, which is an action of type `A` of dashboard_server; see
/// also Command<A>. Most commands only describe their request:
///
///     class PowerOff : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
///       Request request(const Goal &) const override
///       {
///         return {.line = "power off", .reply = "Powering off", .expected = {"robotmode", {"POWER_OFF"}}};
///       }
///     };
///     UR_ROS_RTDE_EXPORT(PowerOff, "dashboard/power_off")
template <typename A>
class DashboardCommand : public DashboardPlugin, private GoalServer<A> {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Request = DashboardRequest;
  using Limits = DashboardLimits;
  using Run = DashboardGoalRun<A>;

  ~DashboardCommand() override { this->stop_server(); }

  virtual Request request(const Goal &) const { return {}; }
  virtual Limits limits() const { return {}; }
  /// By default checks the fields `timeout` and `text` of the goal, if it has them.
  virtual void check(const Goal & goal, Check & check) const;
  /// By default executes request().
  virtual Outcome run(const Goal & goal, Run & run);

  void start_action_server(DashboardHost & host, const std::string & name) override;
  void stop_action_server() override { this->stop_server(); }

 private:
  using Handle = rcl_cxx::ServerGoalHandle<A>;
  rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const Goal & goal) override;
  void execute_goal(Handle & handle, GoalContext & context) override;
  void abort_unstarted(Handle & handle, const Outcome & outcome) override;
  void send_result(Handle & handle, Run & run, const Outcome & outcome);

  DashboardConnection * link_ = nullptr;
  std::unique_ptr<ActiveGoals> goals_;
};

template <typename A>
void DashboardCommand<A>::check(const Goal & goal, Check & check) const
{
  if constexpr (requires { goal.timeout; }) {
    check.above_zero("timeout", goal.timeout, 600.0, "s");
  }
  if constexpr (requires { goal.text; }) {
    check.line("text", goal.text, 1000);
    check_text(goal.text, limits().texts, check);
  }
}

template <typename A>
Outcome DashboardCommand<A>::run(const Goal & goal, Run & run)
{
  const Request wanted = request(goal);
  if constexpr (requires { goal.timeout; }) {
    return run.execute(wanted, goal.timeout);
  } else {
    return run.execute(wanted, wanted.timeout);
  }
}

template <typename A>
void DashboardCommand<A>::start_action_server(DashboardHost & host, const std::string & name)
{
  link_ = &host.link();
  goals_ = std::make_unique<ActiveGoals>(host, host.node().resolve_service_name(name));
  this->start_server(host.node(), name, *goals_, false);
}

template <typename A>
rcl_cxx::GoalDecision DashboardCommand<A>::accept_goal(const rcl_cxx::GoalUUID & id, const Goal & goal)
{
  return goals_->accept(id, [&](GoalContext &) -> Status {
    Check result;
    check(goal, result);
    if (!result.ok()) {
      return tl::unexpected(*result.error());
    }
    const Status ready = dashboard_ready(*link_);
    return ready ? supported(goals_->action(), limits(), *link_) : ready;
  });
}

template <typename A>
void DashboardCommand<A>::execute_goal(Handle & handle, GoalContext & context)
{
  Run goal_run(*link_, context.stop_request, [&]([[maybe_unused]] const std::string & state) {
    if constexpr (requires(Feedback & feedback) { feedback.state; }) {
      Feedback feedback;
      feedback.state = state;
      handle.publish_feedback(feedback);
    }
  });
  const Outcome outcome = guarded(*context.stop_request, [&] { return run(handle.get_goal(), goal_run); });
  send_result(handle, goal_run, outcome);
}

template <typename A>
void DashboardCommand<A>::abort_unstarted(Handle & handle, const Outcome & outcome)
{
  Run run(*link_, std::make_shared<StopRequest>(), {});
  send_result(handle, run, outcome);
}

template <typename A>
void DashboardCommand<A>::send_result(Handle & handle, Run & run, const Outcome & outcome)
{
  if constexpr (requires { run.result().answer; }) {
    run.result().answer = run.answer();
  }
  this->finish(handle, run.result(), outcome);
}

}  // namespace ur_ros_rtde
