#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde/dashboard_link.hpp"
#include "ur_ros_rtde/interrupt.hpp"
#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// How a command shows in the robot's state: the question to the dashboard server, and the answers one of
/// which tells that it has taken effect (as they begin, without their label: "RUNNING").
struct Effect {
  std::string question;
  std::vector<std::string> states;
};

/// What a dashboard command has in hand while it carries out a goal, in the goal's own thread.
class DashboardRun {
 public:
  using PublishState = std::function<void(const std::string &)>;

  DashboardRun(DashboardLink & link, std::shared_ptr<Interrupt> interrupt, PublishState publish);

  /// Sends a line to the dashboard server and returns its answer. Throws RobotError (link_lost).
  std::string ask(const std::string & line);
  /// ask(), without the label that some answers have: "RUNNING" of "Robotmode: RUNNING".
  std::string ask_value(const std::string & question);

  /// Gives a command, whose answer has to begin with `reply`, and waits until the robot's state shows that it
  /// has taken effect; without an Effect where none can be seen.
  Outcome command(const std::string & line, const std::string & reply,
                  const std::optional<Effect> & effect = std::nullopt, double timeout = 0.0);
  /// Asks; the answer, without its label, is the result.
  Outcome query(const std::string & question);

  /// Why the goal has to end now, if it has to.
  std::optional<Interruption> interruption() const { return interrupt_->requested(); }
  /// Returns early, with the reason, when the goal is to end.
  std::optional<Interruption> sleep_for(std::chrono::nanoseconds duration);

  /// The last answer to a command or query, for the result.
  const std::string & answer() const { return answer_; }

 private:
  Outcome until(const Effect & effect, double timeout);

  DashboardLink & link_;
  std::shared_ptr<Interrupt> interrupt_;
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
