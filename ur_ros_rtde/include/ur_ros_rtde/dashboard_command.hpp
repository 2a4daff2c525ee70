#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_text.hpp>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/dashboard_run.hpp"
#include "ur_ros_rtde/goal_book.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

/// A command to the dashboard server as an action of type `A`, for dashboard_server; see Command<A>.
///
///     class PowerOff : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
///       Outcome run(const Goal & goal, Run & run) override
///       {
///         return run.command("power off", "Powering off", Effect{"robotmode", {"POWER_OFF"}}, goal.timeout);
///       }
///     };
///     UR_ROS_RTDE_EXPORT(PowerOff, "dashboard/power_off")
template <typename A>
class DashboardCommand : public DashboardPlugin {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Run = DashboardGoalRun<A>;

  /// By default a field `timeout` and a field `text` of the goal.
  virtual void check(const Goal & goal, Check & check) const
  {
    if constexpr (requires { goal.timeout; }) {
      check.above_zero("timeout", goal.timeout, 600.0, "s");
    }
    if constexpr (requires { goal.text; }) {
      check.line("text", goal.text, 1000);
    }
  }
  virtual Outcome run(const Goal & goal, Run & run) = 0;

  void start_action_server(DashboardHost & host, const std::string & name) override;
  void stop_action_server() override { server_.reset(); }

 private:
  using Handle = rcl_cxx::GoalHandle<A>;
  Status examine(const Goal & goal) const;
  void carry_out(Handle & handle, const std::shared_ptr<Interrupt> & interrupt);
  void conclude(Handle & handle, Run & run, const Outcome & outcome);

  DashboardLink * link_ = nullptr;
  std::unique_ptr<GoalBook> book_;
  typename rcl_cxx::ActionServer<A>::SharedPtr server_;
};

/// Why the dashboard server cannot be spoken to, if so.
Status dashboard_ready(const DashboardLink & link);

template <typename A>
void DashboardCommand<A>::start_action_server(DashboardHost & host, const std::string & name)
{
  link_ = &host.link();
  book_ = std::make_unique<GoalBook>(host, host.node().resolve_service_name(name));
  rcl_cxx::ActionHandlers<A> handlers;
  handlers.goal = [this](const rcl_cxx::GoalId & id, const Goal & goal) {
    return book_->admit(id, [&](GoalBook::Ticket &) { return examine(goal); });
  };
  handlers.accepted = [this](std::shared_ptr<Handle> handle) {
    const Status started = book_->start(
        handle->goal_id(),
        [this, handle](std::shared_ptr<GoalBook::Ticket> ticket) { carry_out(*handle, ticket->interrupt); });
    if (!started) {
      Run run(*link_, std::make_shared<Interrupt>(), {});
      conclude(*handle, run, started);
    }
  };
  handlers.cancel = [](Handle &) { return true; };
  handlers.canceling = [this](Handle & handle) { book_->cancel(handle.goal_id()); };
  server_ = host.node().template create_action_server<A>(name, std::move(handlers));
}

template <typename A>
Status DashboardCommand<A>::examine(const Goal & goal) const
{
  Check result;
  check(goal, result);
  return result.ok() ? dashboard_ready(*link_) : Status(tl::unexpected(*result.error()));
}

template <typename A>
void DashboardCommand<A>::carry_out(Handle & handle, const std::shared_ptr<Interrupt> & interrupt)
{
  Run goal_run(*link_, interrupt, [&handle]([[maybe_unused]] const std::string & state) {
    if constexpr (requires(Feedback & feedback) { feedback.state; }) {
      Feedback feedback;
      feedback.state = state;
      handle.publish_feedback(feedback);
    }
  });
  const Outcome outcome = book_->guarded(*interrupt, [&] { return run(handle.goal(), goal_run); });
  conclude(handle, goal_run, outcome);
}

template <typename A>
void DashboardCommand<A>::conclude(Handle & handle, Run & run, const Outcome & outcome)
{
  Result & result = run.result();
  result.success = static_cast<bool>(outcome);
  result.error_code = static_cast<std::uint16_t>(outcome.code());
  result.message = outcome.message();
  if constexpr (requires { result.answer; }) {
    result.answer = run.answer();
  }
  book_->finish(handle.goal_id(), outcome);
  if (outcome) {
    handle.succeed(result);
  } else if (outcome.code() == ErrorCode::canceled && handle.is_canceling()) {
    handle.canceled(result);
  } else {
    handle.abort(result);
  }
}

}  // namespace ur_ros_rtde
