#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_link.hpp"

namespace ur_ros_rtde {

/// How a command shows in the robot's state: the question to the dashboard server, and the answers one of
/// which tells that it has taken effect (as they begin, without their label: "RUNNING").
struct Effect {
  std::string question;
  std::vector<std::string> states;
};

/// The version of PolyScope from which on there is something.
struct Since {
  unsigned major = 0;
  unsigned minor = 0;
};
constexpr Since never{~0U, 0};

/// A command or question to the dashboard server (UR, "Dashboard Server e-Series, port 29999", "…
/// CB-Series").
struct DashboardRequest {
  std::string line;
  /// How the answer begins when it is done. Empty: a question, any answer to which is one.
  std::string reply{};
  /// With an empty question: nothing to be seen.
  Effect effect{};
  /// s, for answer and effect, where the goal has no field `timeout`.
  double timeout = 60.0;
};

/// What has such a command, and what may be said with it.
struct DashboardLimits {
  Since e_series{5, 0};
  Since cb3{3, 0};
  /// What the goal's field `text` may be; empty: any line.
  std::vector<std::string> texts{};
};

/// not_supported, naming the versions, when the controller's is not within `limits`; success while it is not
/// known.
Status supported(const std::string & action, const DashboardLimits & limits, const DashboardLink & link);

/// What a dashboard command has in hand while it carries out a goal, in the goal's own thread.
class DashboardRun {
 public:
  using PublishState = std::function<void(const std::string &)>;

  DashboardRun(DashboardLink & link, std::shared_ptr<StopRequest> stop_request, PublishState publish);

  /// Sends a line to the dashboard server and returns its answer, which has to come within 2.5 s. Throws
  /// RobotError (link_lost).
  std::string ask(const std::string & line);
  /// ask(), without the label that some answers have: "RUNNING" of "Robotmode: RUNNING".
  std::string ask_value(const std::string & question);

  /// Gives a command, whose answer has to begin with `reply`, and waits until the robot's state shows that it
  /// has taken effect; with an Effect without a question, not. `timeout`: s, for both together.
  Outcome command(const std::string & line, const std::string & reply, const Effect & effect = {},
                  double timeout = 60.0);
  /// Asks; the answer, without its label, is the result.
  Outcome query(const std::string & question);
  /// Sends a line on a connection of its own; the answer, whatever it is, is the result.
  Outcome raw(const std::string & line, double timeout = 60.0);
  /// command() or query(), as the request is.
  Outcome execute(const DashboardRequest & request, double timeout);

  /// Why the goal has to end now, if it has to.
  std::optional<StopReason> stop_reason() const { return stop_request_->reason(); }
  /// Returns early, with the reason, when the goal is to end.
  std::optional<StopReason> sleep_for(std::chrono::nanoseconds duration);

  /// The last answer to a command or query, for the result.
  const std::string & answer() const { return answer_; }

 private:
  using Clock = std::chrono::steady_clock;
  Outcome rejection(const std::string & line);
  Outcome until(const Effect & effect, Clock::time_point deadline, double timeout);

  DashboardLink & link_;
  std::shared_ptr<StopRequest> stop_request_;
  PublishState publish_;
  std::string answer_;
};

/// DashboardRun, with the result of action `A`.
template <typename A>
class DashboardGoalRun : public DashboardRun {
 public:
  using DashboardRun::DashboardRun;
  /// For fields of your own; success, error_code, message and answer are filled in for you.
  typename A::Result & result() { return result_; }

 private:
  typename A::Result result_;
};

}  // namespace ur_ros_rtde
