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

std::shared_ptr<const urscript::Library> make_robot_library(const RobotAccess & access)
{
  auto library = std::make_shared<urscript::Library>();
  const auto robot = std::make_shared<script_api::RobotContext>(access);
  // First, so that modelled builtins of the same name replace them.
  script_api::add_unmodelled_builtins(*library);
  urscript::add_standard_builtins(*library);
  script_api::add_move_builtins(*library, robot);
  script_api::add_servo_speed_builtins(*library, robot);
  script_api::add_force_builtins(*library, robot);
  script_api::add_freedrive_builtins(*library, robot);
  script_api::add_state_builtins(*library, robot);
  script_api::add_kinematics_builtins(*library, robot);
  script_api::add_dynamics_builtins(*library, robot);
  script_api::add_installation_builtins(*library, robot);
  script_api::add_register_builtins(*library, robot);
  script_api::add_digital_io_builtins(*library, robot);
  script_api::add_analog_io_builtins(*library, robot);
  script_api::add_controller_builtins(*library, robot);
  script_api::add_gripper_builtins(*library, robot);
  return library;
}

}  // namespace ur_simulator
