#pragma once

#include <memory>

#include "dynamics/dynamics.hpp"
#include "script_api/robot_library.hpp"
#include "urscript/argument_reader.hpp"

namespace ur_simulator::script_api {

using urscript::ArgumentReader;
using urscript::Arguments;
using urscript::CallContext;
using urscript::Failure;
using urscript::Library;
using urscript::NextCycle;
using urscript::Outcome;
using urscript::Value;

class MotionOperation;

/// What the robot builtins of one library share.
struct Robot {
  explicit Robot(const RobotAccess & robot_access) : access(robot_access), dynamics(robot_access.model) {}

  ControllerState & state() const { return access.state; }

  RobotAccess access;
  Dynamics dynamics;
  /// The call that moves the arm now: only one thread of a program may.
  const MotionOperation * moving = nullptr;
  /// Where it goes, for get_target_waypoint(). A TCP pose.
  Vector6 waypoint = Vector6::Zero();
};

using RobotPtr = std::shared_ptr<Robot>;

/// Adds a builtin that acts on the robot.
void add_bound(Library & library, const RobotPtr & robot, const char * name,
               std::vector<urscript::Parameter> parameters, std::size_t required,
               Outcome (*function)(Robot & robot, Arguments arguments), std::uint32_t cost = 15);

// The groups of make_robot_library.
void add_move_builtins(Library & library, const RobotPtr & robot);
void add_speed_builtins(Library & library, const RobotPtr & robot);
void add_force_builtins(Library & library, const RobotPtr & robot);
void add_hand_guiding_builtins(Library & library, const RobotPtr & robot);
void add_state_builtins(Library & library, const RobotPtr & robot);
void add_kinematics_builtins(Library & library, const RobotPtr & robot);
void add_dynamics_builtins(Library & library, const RobotPtr & robot);
void add_installation_builtins(Library & library, const RobotPtr & robot);
void add_register_builtins(Library & library, const RobotPtr & robot);
void add_digital_io_builtins(Library & library, const RobotPtr & robot);
void add_analog_io_builtins(Library & library, const RobotPtr & robot);
void add_controller_builtins(Library & library, const RobotPtr & robot);
/// What the URCap of the gripper contributes, when there is one.
void add_gripper_builtins(Library & library, const RobotPtr & robot);
void add_builtins_not_modelled(Library & library);

}  // namespace ur_simulator::script_api
