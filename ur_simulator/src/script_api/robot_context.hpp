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

/// State that the robot builtins of one library share.
struct RobotContext {
  explicit RobotContext(RobotAccess robot_access) : access(std::move(robot_access)), dynamics(access.model) {}

  ControllerState & state() const { return access.state; }

  RobotAccess access;
  Dynamics dynamics;
  /// The call that moves the arm. Only one thread of a program may move the arm at a time.
  MotionOperation * motion_owner = nullptr;
  /// TCP pose of the target of the current motion, for get_target_waypoint().
  Vector6 waypoint = Vector6::Zero();
};

using RobotContextPtr = std::shared_ptr<RobotContext>;

/// Adds a builtin that gets the robot context and its arguments only.
void add_robot_builtin(Library & library, const RobotContextPtr & robot, const char * name,
                       std::vector<urscript::Parameter> parameters, std::size_t required,
                       Outcome (*function)(RobotContext & robot, Arguments arguments),
                       std::uint32_t cost = 15);

// Groups of builtins that make_robot_library() adds.
void add_move_builtins(Library & library, const RobotContextPtr & robot);
void add_servo_speed_builtins(Library & library, const RobotContextPtr & robot);
void add_path_offset_builtins(Library & library, const RobotContextPtr & robot);
void add_force_builtins(Library & library, const RobotContextPtr & robot);
void add_freedrive_builtins(Library & library, const RobotContextPtr & robot);
void add_state_builtins(Library & library, const RobotContextPtr & robot);
void add_kinematics_builtins(Library & library, const RobotContextPtr & robot);
void add_dynamics_builtins(Library & library, const RobotContextPtr & robot);
void add_installation_builtins(Library & library, const RobotContextPtr & robot);
void add_estimate_payload_builtin(Library & library, const RobotContextPtr & robot);
void add_register_builtins(Library & library, const RobotContextPtr & robot);
/// Access to the registers and bits of the MODBUS server.
void add_port_builtins(Library & library, const RobotContextPtr & robot);
void add_digital_io_builtins(Library & library, const RobotContextPtr & robot);
void add_analog_io_builtins(Library & library, const RobotContextPtr & robot);
void add_tool_connector_builtins(Library & library, const RobotContextPtr & robot);
void add_interpreter_builtins(Library & library, const RobotContextPtr & robot);
void add_controller_builtins(Library & library, const RobotContextPtr & robot);
/// Functions of the gripper's URCap, if a gripper is mounted.
void add_gripper_builtins(Library & library, const RobotContextPtr & robot);
void add_encoder_builtins(Library & library, const RobotContextPtr & robot);
void add_world_model_builtins(Library & library, const RobotContextPtr & robot);
void add_setting_builtins(Library & library);
void add_stored_setting_builtins(Library & library);
void add_rejected_builtins(Library & library);

}  // namespace ur_simulator::script_api
