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

// Those that need the robot.
constexpr void (*add_builtins[])(urscript::Library & library, const script_api::RobotContextPtr & robot) = {
    script_api::add_move_builtins,           script_api::add_servo_speed_builtins,
    script_api::add_path_offset_builtins,    script_api::add_force_builtins,
    script_api::add_freedrive_builtins,      script_api::add_state_builtins,
    script_api::add_kinematics_builtins,     script_api::add_dynamics_builtins,
    script_api::add_installation_builtins,   script_api::add_estimate_payload_builtin,
    script_api::add_register_builtins,       script_api::add_port_builtins,
    script_api::add_digital_io_builtins,     script_api::add_analog_io_builtins,
    script_api::add_tool_connector_builtins, script_api::add_controller_builtins,
    script_api::add_interpreter_builtins,    script_api::add_encoder_builtins,
    script_api::add_world_model_builtins,    script_api::add_gripper_builtins,
};

}  // namespace

std::shared_ptr<const urscript::Library> make_robot_library(const RobotAccess & access)
{
  auto library = std::make_shared<urscript::Library>();
  const auto robot = std::make_shared<script_api::RobotContext>(access);
  urscript::add_standard_builtins(*library);
  for (const auto add : add_builtins) {
    add(*library, robot);
  }
  script_api::add_setting_builtins(*library);
  script_api::add_stored_setting_builtins(*library);
  script_api::add_rejected_builtins(*library);
  return library;
}

}  // namespace ur_simulator
