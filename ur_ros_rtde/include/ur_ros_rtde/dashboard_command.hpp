#pragma once

#include <memory>
#include <string>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_text.hpp>

#include "ur_ros_rtde/detail/dashboard_command_base.hpp"

namespace ur_ros_rtde {

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
class DashboardCommand : public DashboardCommandBase {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Request = DashboardRequest;
  using Limits = DashboardLimits;
  using Run = DashboardGoalRun<A>;

  ~DashboardCommand() override { DashboardCommandBase::stop_action_server(); }

  virtual Request request(const Goal &) const { return {}; }
  /// By default checks the fields `timeout` and `text` of the goal, if it has them.
  virtual void check(const Goal & goal, Check & check) const;
  /// By default executes request().
  virtual Outcome run(const Goal & goal, Run & run);

  /// Writes the outcome into the result. Override it for results that begin with other fields.
  virtual void fill_result(const Outcome & outcome, Result & result) const
  {
    write_standard_fields(outcome, result);
  }

 private:
  static const Goal & typed(const void * goal) { return *static_cast<const Goal *>(goal); }

  const rcl_cxx::ActionType & action_type() const final { return rcl_cxx::action_type<A>(); }
  void check_goal(const void * goal, Check & result) const final { check(typed(goal), result); }
  std::unique_ptr<DashboardRun> make_run(DashboardConnection & connection,
                                         std::shared_ptr<StopRequest> stop_request,
                                         PublishFeedback publish) const final
  {
    return std::make_unique<Run>(connection, std::move(stop_request), std::move(publish));
  }
  Outcome run_goal(const void * goal, DashboardRun & goal_run) final
  {
    return run(typed(goal), static_cast<Run &>(goal_run));
  }
  void write_outcome(const Outcome & outcome, void * result) const final
  {
    fill_result(outcome, *static_cast<Result *>(result));
  }
  void write_failure(const Outcome & outcome, void * result) const final
  {
    write_standard_fields(outcome, *static_cast<Result *>(result));
  }
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

}  // namespace ur_ros_rtde
