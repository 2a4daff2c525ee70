#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"

namespace ur_ros_rtde {

/// The state of the robot after a command: a query to the dashboard server and the answers that confirm that
/// the command has taken effect, without their label ("RUNNING") and without what follows.
struct ExpectedState {
  std::string query;
  std::vector<std::string> states;
  /// The answer to the command is proof enough. The state may have been left again before it is seen, as when
  /// the driver starts its control program again: it is waited for, but for 1 s at most, and not required.
  bool is_confirmed_by_answer = false;
};

/// The oldest version of PolyScope that supports a command.
struct MinVersion {
  unsigned major = 0;
  unsigned minor = 0;
};
constexpr MinVersion never{~0U, 0};

/// What a command starts. Its line is not sent after a stop that came later than the goal.
enum class Starts {
  nothing,
  power,    ///< a stop that comes later waits for the answer
  program,  ///< it may move the arm: a stop that comes later, and a goal that fails, end it
};

/// A command or query to the dashboard server (UR, "Dashboard Server e-Series, port 29999", "… CB-Series").
struct DashboardRequest {
  std::string line;
  /// The beginning of the answer to a successful command. Empty: the line is a query, and every answer is
  /// valid.
  std::string reply{};
  /// Without a query, the command is finished with its answer.
  ExpectedState expected{};
  /// s, for the answer and the expected state together, if the goal has no field `timeout`.
  double timeout = 60.0;
  Starts starts = Starts::nothing;
};

/// The controllers that support a command, and the values of its text.
struct DashboardLimits {
  MinVersion e_series{5, 0};
  MinVersion cb3{3, 0};
  /// Allowed values of the goal's field `text`. Empty: any line.
  std::vector<std::string> texts{};
};

/// Fails (not_supported) with the supported versions if the controller is not within `limits`. Succeeds while
/// its version is unknown.
Status supported(const std::string & action, const DashboardLimits & limits,
                 const DashboardConnection & connection);

/// Gives a dashboard command access to the dashboard server while it executes a goal, in the goal's thread.
class DashboardRun {
 public:
  // For the driver

  /// Null if no stop can come; fails if one has come.
  using BeginStart = std::function<Expected<std::shared_ptr<void>>()>;

  DashboardRun(DashboardConnection & connection, std::shared_ptr<const StopRequest> stop_request,
               BeginStart begin_start = {});
  virtual ~DashboardRun() = default;
  DashboardRun(const DashboardRun &) = delete;
  DashboardRun & operator=(const DashboardRun &) = delete;

  // Requests

  /// Sends a line to the dashboard server and returns its answer. Throws RobotError (link_lost, timeout after
  /// 5 s).
  std::string send(const std::string & line);
  /// The answer without its label: "RUNNING" for "Robotmode: RUNNING".
  std::string query_value(const std::string & question);

  bool is_program_stopped() { return query_value("programState").starts_with("STOPPED"); }

  /// Sends a command whose answer has to begin with `reply`, and waits for the expected state, if there is
  /// one. `timeout`: s, for both together.
  Outcome command(const std::string & line, const std::string & reply, const ExpectedState & expected = {},
                  double timeout = 60.0);
  /// Sends a query. Its answer, without the label, is the message of the outcome.
  Outcome query(const std::string & question);
  /// Sends a line on a connection of its own. Every answer counts as success and is the message of the
  /// outcome.
  Outcome raw(const std::string & line, double timeout = 60.0);
  /// Executes the request with command() or query(). Only this function heeds DashboardRequest::starts.
  Outcome execute(const DashboardRequest & request, double timeout);

  // Waits and result

  /// Why the goal has to stop now. Empty: it may continue.
  std::optional<StopReason> stop_reason() const { return stop_request_->reason(); }
  /// Returns early, with the reason, when the goal has to stop.
  std::optional<StopReason> sleep_for(std::chrono::nanoseconds duration);

  /// The last answer to a command or query, for the result.
  const std::string & answer() const { return answer_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Publishes the answer to the query of an expected state, when it changes.
  virtual void publish_state(const std::string & state) = 0;
  /// Ends a program that it may have started if it does not succeed.
  Outcome start(const DashboardRequest & request, double timeout);
  Expected<std::shared_ptr<void>> begin_start();
  /// Why what is being started must not go on: the goal has to stop, or a stop came later than the goal.
  std::optional<Error> overtaken();
  /// Ends the program that may have been started. Returns `why`, and whether it may still begin.
  Outcome end_program(Error why);
  Outcome take_answer(const std::string & line, const Expected<std::string> & answer);
  Outcome rejection(const std::string & line);
  Outcome until(const ExpectedState & expected, Clock::time_point deadline, double timeout,
                bool starts_program = false);

  DashboardConnection & connection_;
  std::shared_ptr<const StopRequest> stop_request_;
  const BeginStart begin_start_;
  std::string answer_;
};

/// DashboardRun with the result and the feedback of action `A`.
template <typename A>
class DashboardGoalRun : public DashboardRun {
 public:
  // For the driver

  using PublishFeedback = std::function<void(const void * feedback)>;

  DashboardGoalRun(DashboardConnection & connection, std::shared_ptr<const StopRequest> stop_request,
                   BeginStart begin_start, PublishFeedback publish)
      : DashboardRun(connection, std::move(stop_request), std::move(begin_start)),
        publish_(std::move(publish))
  {
  }

  // Result

  /// Set the fields that are specific to the action. `success`, `error_code`, `message` and `answer` are
  /// filled in by the base class.
  typename A::Result & result() { return result_; }

 private:
  void publish_state([[maybe_unused]] const std::string & state) override
  {
    if constexpr (requires(typename A::Feedback & feedback) { feedback.state; }) {
      typename A::Feedback feedback;
      feedback.state = state;
      publish_(&feedback);
    }
  }

  typename A::Result result_;
  PublishFeedback publish_;
};

}  // namespace ur_ros_rtde
