#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Force mode, freedrive or teach mode, on as long as this object exists. Its destructor stops a motion that
/// goes on, then ends the mode. If the goal has to end before, the driver does both.
///
///     const Mode pressing = start_force_mode(run, options);
///     if (Outcome found = search(run); !found) {
///       return found;  // the mode ends
///     }
class [[nodiscard]] Mode {
 public:
  /// A function of ur_rtde that ends the mode.
  using EndFunction = bool (ur_rtde::RTDEControlInterface::*)();

  Mode(Run & run, EndFunction function, std::string name)
      : run_(run), function_(function), name_(std::move(name))
  {
  }
  /// A failure to end the mode is a warning of the goal.
  ~Mode();
  Mode(const Mode &) = delete;
  Mode & operator=(const Mode &) = delete;

  /// Ends the mode now, after the motion in it has ended. The arm decelerates: wait for its standstill before
  /// the next motion. Throws RobotError (rejected_by_robot) if the control program did not end it.
  void end();
  /// Leaves the mode on. For commands with CommandTraits::leaves_mode_active; after all others, the driver
  /// ends it.
  void keep_on() { on_ = false; }

 private:
  Run & run_;
  const EndFunction function_;
  const std::string name_;
  bool on_ = true;  ///< and has to be ended
};

/// The arguments of URScript's force_mode(); the defaults are those of the action ForceMode.
struct ForceModeOptions {
  std::vector<double> task_frame = std::vector<double>(6, 0.0);  ///< UR pose in the base frame: m, rad
  std::array<bool, 6> compliant{};                               ///< x, y, z, rx, ry, rz of the task frame
  std::array<double, 6> wrench{};  ///< N and Nm along the compliant axes, in the task frame
  int type = 2;                    ///< 1 to 3: see the action; 2: the task frame is not transformed
  /// Compliant axes: maximum speed, m/s and rad/s. Others: maximum deviation from the path, m and rad.
  std::array<double, 6> limits{0.1, 0.1, 0.1, 0.5, 0.5, 0.5};
  double damping = 0.025;     ///< 0 to 1
  double gain_scaling = 0.5;  ///< 0 to 2
};

/// Checks what the control program does not, with the names of the fields of the action ForceMode.
Check & check_force_mode(Check & check, const ForceModeOptions & options);

/// Makes axes compliant. Motions of the same goal follow their path in the other axes. To change
/// the options, call it again, and keep_on() of what it returns: the first object ends the mode. These
/// functions throw RobotError: busy if another mode excludes this one, invalid_goal for options that are not
/// valid, rejected_by_robot if the control program did not switch it on.
Mode start_force_mode(Run & run, const ForceModeOptions & options);
/// Lets the arm be moved by hand along `free_axes` (x, y, z, rx, ry, rz) of `feature`, a UR pose in the base
/// frame (m, rad).
Mode start_freedrive(Run & run, const std::array<bool, 6> & free_axes, const std::vector<double> & feature);
/// Lets the arm be moved by hand.
Mode start_teach_mode(Run & run);

}  // namespace ur_ros_rtde
