#include "script_api/robot_library.hpp"

#include "script_api/robot_context.hpp"

namespace ur_simulator {

namespace script_api {

void add_robot_builtin(Library & library, const RobotContextPtr & robot, const char * name,
                       std::vector<urscript::Parameter> parameters, std::size_t required,
                       Outcome (*function)(RobotContext & robot, Arguments arguments), std::uint32_t cost)
{
  const auto bound = [robot, function](CallContext &, Arguments arguments) {
    return function(*robot, arguments);
  };
  library.add({name, std::move(parameters), required, bound, false, cost});
}

}  // namespace script_api

namespace {

struct BuiltinGroup {
  const char * title;
  void (*add)(urscript::Library & library, const script_api::RobotContextPtr & robot);
};

constexpr BuiltinGroup builtin_groups[] = {
    {"motion", script_api::add_move_builtins},
    {"motion", script_api::add_servo_speed_builtins},
    {"path offset", script_api::add_path_offset_builtins},
    {"force mode, freedrive, contact", script_api::add_force_builtins},
    {"force mode, freedrive, contact", script_api::add_freedrive_builtins},
    {"state", script_api::add_state_builtins},
    {"kinematics, dynamics", script_api::add_kinematics_builtins},
    {"kinematics, dynamics", script_api::add_dynamics_builtins},
    {"payload, TCP, sensor", script_api::add_installation_builtins},
    {"payload, TCP, sensor", script_api::add_estimate_payload_builtin},
    {"registers", script_api::add_register_builtins},
    {"MODBUS server", script_api::add_port_builtins},
    {"digital IO", script_api::add_digital_io_builtins},
    {"analog IO", script_api::add_analog_io_builtins},
    {"tool connector", script_api::add_tool_connector_builtins},
    {"controller", script_api::add_controller_builtins},
    {"interpreter mode", script_api::add_interpreter_builtins},
    {"encoders", script_api::add_encoder_builtins},
    {"world model", script_api::add_world_model_builtins},
    {"OnRobot gripper URCap", script_api::add_gripper_builtins},
};

}  // namespace

std::shared_ptr<const urscript::Library> make_robot_library(const RobotAccess & access)
{
  auto library = std::make_shared<urscript::Library>();
  const auto robot = std::make_shared<script_api::RobotContext>(access);
  urscript::add_standard_builtins(*library);
  for (const auto & [title, add] : builtin_groups) {
    library->begin_group(title);
    add(*library, robot);
  }
  library->begin_group("settings");
  script_api::add_setting_builtins(*library);
  script_api::add_stored_setting_builtins(*library);
  script_api::add_rejected_builtins(*library);
  return library;
}

}  // namespace ur_simulator
