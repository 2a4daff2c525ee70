#pragma once

#include <memory>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_text.hpp>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/dashboard_run.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

// For the driver

/// Success if the robot has a dashboard server, and it is connected and has a version within `limits`.
Status dashboard_ready(const std::string & action, const DashboardLimits & limits, DashboardHost & host);

/// Why the script of a goal ends if `goal` stops the program.
Error stopped_through_dashboard(const std::string & goal);

/// Fails unless `text` is one of `texts`. Every text is allowed if `texts` is empty.
void check_text(const std::string & text, const std::vector<std::string> & texts, Check & check);

// For plugins

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
class DashboardCommand : public DashboardPlugin {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Request = DashboardRequest;
  using Limits = DashboardLimits;
  using Run = DashboardGoalRun<A>;

  ~DashboardCommand() override { stop_server(); }

  // To override

  /// The versions of PolyScope that have the command, and the valid values of the goal's field `text`.
  virtual Limits limits() const { return {}; }
  /// The line to send, and the answer and the state of the robot that confirm it.
  virtual Request request(const Goal &) const { return {}; }
  /// The command ends the program of the robot. Its goals also end a script of the driver that has not begun
  /// yet, which the dashboard server does not know, and make_ready.
  virtual bool stops_program() const { return false; }
  /// Of those: the arm has no power afterwards. A request of make_ready that is under way ends before.
  virtual bool powers_off() const { return false; }
  /// The command stops the arm: its goals are served by the thread that serves stops, beside the limit of
  /// goals.
  virtual bool stops_arm() const { return stops_program(); }
  /// By default checks the fields `timeout` and `text` of the goal, if it has them.
  virtual void check(const Goal & goal, Check & check) const;
  /// By default executes request().
  virtual Outcome run(const Goal & goal, Run & run);
  /// Writes the outcome into the result. Override it for results that begin with other fields. Also asked
  /// when the command is loaded, for goals that it never gets.
  virtual void fill_result(const Outcome & outcome, Result & result) const
  {
    write_standard_fields(outcome, result);
  }

  // For the driver

  void start_action_server(DashboardHost & host, const std::string & name) override;
  void stop_action_server() override { stop_server(); }

 private:
  class GoalOfCommand;
  void stop_server() { server_.reset(); }

  std::unique_ptr<GoalServer> server_;
};

/// A goal of this command, with its types.
template <typename A>
class DashboardCommand<A>::GoalOfCommand final : public ur_ros_rtde::Goal {
 public:
  GoalOfCommand(DashboardCommand & command, DashboardHost & host, const std::string & action,
                const rcl_cxx::GoalUUID & id, const typename A::Goal & message)
      : ur_ros_rtde::Goal(host, action, id), command_(command), host_(host), message_(message)
  {
  }

 private:
  Status check(std::vector<GoalQuery> &) override
  {
    stops_before_ = host_.stops();
    Check check;
    command_.check(message_, check);
    const Status ready =
        check.ok() ? dashboard_ready(action(), command_.limits(), host_) : tl::unexpected(*check.error());
    if (ready && command_.stops_program()) {
      hold_ = host_.end_script(stopped_through_dashboard(name()));
    }
    return ready;
  }
  /// Not while a program that it has started may begin.
  std::optional<Status> stopped() const override
  {
    return host_.has_startup_requests() ? std::nullopt : std::make_optional(Status());
  }
  Outcome execute() override
  {
    run_.emplace(
        host_.connection(), shared_stop_request(),
        [this] { return host_.begin_startup_request(stops_before_); },
        [this](const void * feedback) { handle().publish_feedback(feedback); });
    const auto hold = std::move(hold_);
    if (command_.powers_off()) {
      host_.wait_for_startup_requests();
    }
    const auto run = [this] { return command_.run(message_, *run_); };
    const bool may_begin = command_.stops_program() && !command_.powers_off() && host_.has_startup_requests();
    const Outcome outcome = guarded(stop_request(), run);
    if (!may_begin) {
      return outcome;
    }
    host_.wait_for_startup_requests();  // a program may begin after the stop
    return guarded(stop_request(), [&] { return run_->is_program_stopped() ? outcome : run(); });
  }
  void send_result(const Outcome & outcome, bool abandoned) override
  {
    Result unused;
    const bool has_run = !abandoned && run_;
    Result & result = has_run ? run_->result() : unused;
    if constexpr (requires { result.answer; }) {
      result.answer = has_run ? run_->answer() : std::string();
    }
    const Outcome actual = write_outcome(command_, outcome, result);
    send(actual, &result);
  }

  DashboardCommand & command_;
  DashboardHost & host_;
  const typename A::Goal & message_;
  std::uint32_t stops_before_ = 0;  ///< CommandHost::stops()
  std::shared_ptr<void> hold_;  ///< of the control program, until the program of the robot has been stopped
  std::optional<Run> run_;
};

template <typename A>
void DashboardCommand<A>::start_action_server(DashboardHost & host, const std::string & name)
{
  const std::string action = host.node().resolve_service_name(name);
  server_ = std::make_unique<GoalServer>(
      host, GoalServer::Description{.type = rcl_cxx::action_type<A>(), .name = name, .is_stop = stops_arm()},
      [this, &host, action](const rcl_cxx::GoalUUID & id, const void * message) {
        return std::make_shared<GoalOfCommand>(*this, host, action, id,
                                               *static_cast<const typename A::Goal *>(message));
      },
      make_missing_results(*this));
}

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
