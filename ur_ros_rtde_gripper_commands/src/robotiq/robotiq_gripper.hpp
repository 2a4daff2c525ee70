#pragma once

#include <functional>
#include <string>
#include <ur_ros_rtde/run.hpp>

#include "robotiq/robotiq_client.hpp"

namespace ur_ros_rtde_gripper_commands {

constexpr int max_register = 255;

/// The status registers (Robotiq, "2F-85 & 2F-140 Instruction Manual", register mapping).
struct RobotiqState {
  int status = 0;    ///< STA: 0 reset, 1 activation in progress, 3 active
  int contact = 0;   ///< OBJ: 0 in motion, 1 contact while opening, 2 contact while closing, 3 at the target
  int fault = 0;     ///< FLT: 0 none
  int position = 0;  ///< POS: 0 open
  int go_to = 0;     ///< GTO: 1 moves to the target; without it, OBJ means nothing

  bool active() const { return status == 3; }
  bool object_detected() const { return go_to == 1 && (contact == 1 || contact == 2); }
  bool operator==(const RobotiqState &) const = default;
};

/// Cause and remedy of a fault code.
std::string robotiq_fault_text(int fault);

/// The range of the fingers. Closed ones meet before the largest position that can be requested, except those
/// of a Hand-E.
struct FingerRange {
  double stroke = 0.0;      ///< m
  int closed_position = 0;  ///< register POS

  /// The width between the fingers (m), which is nearly linear in the position; 0 beyond closed_position.
  double width(int position) const;
  int position(double width) const;
};

struct RobotiqTarget {
  int position = 0;
  int speed = max_register;
  int force = 0;
};

/// A gripper for the duration of a goal. Waits end early when the goal has to stop; then the fingers stop.
class RobotiqGripper {
 public:
  using Observer = std::function<void(const RobotiqState &)>;

  /// `observe` gets each state that is read during a wait. Throws RobotError if the URCap does not answer.
  RobotiqGripper(ur_ros_rtde::Run & run, double timeout, Observer observe);

  RobotiqState read();
  /// Activates the gripper; with `reset`, also an active one.
  ur_ros_rtde::Outcome activate(bool reset);
  /// Moves the fingers until they have stopped, at the target or at a contact.
  ur_ros_rtde::Outcome move(const RobotiqTarget & target);

 private:
  using Condition = std::function<bool(const RobotiqState &)>;
  ur_ros_rtde::Outcome until(const Condition & condition, const std::string & otherwise);
  ur_ros_rtde::Outcome start_motion(const RobotiqTarget & target);
  ur_ros_rtde::Outcome until_stopped(int target);
  ur_ros_rtde::Outcome clear();
  ur_ros_rtde::Outcome start_activation();
  ur_ros_rtde::Outcome stop_unless_successful(const std::function<ur_ros_rtde::Outcome()> & body,
                                              const std::string & registers);
  void set(const std::string & assignments);
  int get(std::string_view name);

  ur_ros_rtde::Run & run_;
  std::chrono::steady_clock::time_point deadline_;
  Observer observe_;
  RobotiqClient client_;
};

}  // namespace ur_ros_rtde_gripper_commands
