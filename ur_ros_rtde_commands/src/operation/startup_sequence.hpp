#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/action/make_ready.hpp>

#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"
#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Brings the robot from any state to running, as far as that is safe without an operator (UR, "Dashboard
/// Server e-Series", and the robot modes in the user manual).
class StartupSequence {
 public:
  using Goal = ur_ros_rtde_msgs::action::MakeReady::Goal;

  StartupSequence(const Run & run, const Goal & goal)
      : run_(run), robot_(run.robot()), goal_(goal), dashboard_(robot_.address())
  {
  }

  /// Executes the next step and describes it. Returns an empty string when the robot is ready. Throws
  /// RobotError with the reason and the remedy if an operator has to act, link_lost, or the reason of a stop.
  std::string step();

 private:
  using Clock = std::chrono::steady_clock;

  std::string next_step();
  std::string leave_safety_stop(const std::string & mode);
  std::string unlock_protective_stop();
  std::string restart_safety(const std::string & mode);
  std::string start_arm(const std::string & mode);
  std::string start_program();
  void close_popups();
  /// Sends a command, unless there was a stop. The same command is repeated no earlier than after
  /// `repeat_interval`, or after 1 s if it was rejected.
  void command(const std::string & line, const std::string & reply,
               std::chrono::milliseconds repeat_interval);

  const Run & run_;
  const Robot & robot_;
  const Goal & goal_;
  DashboardSession dashboard_;  ///< of the current step
  std::string last_command_;
  std::string last_rejection_;
  Clock::time_point last_command_time_{};
  bool popups_closed_ = false;
  std::optional<Clock::time_point> blocked_since_;  ///< since when the control program cannot be started
};

}  // namespace ur_ros_rtde
