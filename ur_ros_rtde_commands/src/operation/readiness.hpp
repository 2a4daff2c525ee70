#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/action/make_ready.hpp>

#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Brings a robot from whatever state it is in towards running, a step a look, as far as that is safe without
/// a person (UR, "Dashboard Server e-Series", and the robot modes of the user manual).
class Readiness {
 public:
  using Goal = ur_ros_rtde_msgs::action::MakeReady::Goal;

  Readiness(const Robot & robot, const Goal & goal) : robot_(robot), goal_(goal) {}

  /// What is being done now, for people; empty: ready. Throws RobotError when only a person can go on, with
  /// the reason and what to do, and link_lost.
  std::string step();

 private:
  using Clock = std::chrono::steady_clock;

  std::string leave_safety_stop(const std::string & mode);
  std::string unlock();
  std::string restart_safety(const std::string & mode);
  std::string start_arm(const std::string & mode);
  std::string start_program();
  void close_popups();
  /// Gives a command until it shows: again after the time it takes, or after a second when it was refused.
  void command(const std::string & line, const std::string & reply, std::chrono::milliseconds takes);

  const Robot & robot_;
  const Goal & goal_;
  std::string last_command_;
  std::string last_refusal_;
  Clock::time_point last_command_time_{};
  bool popups_closed_ = false;
  std::optional<Clock::time_point> kept_since_;  ///< by another program
};

}  // namespace ur_ros_rtde
