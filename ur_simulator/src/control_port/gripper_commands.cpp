#include <array>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

json soft_gripper(ControlPortContext & context, RequestFields & fields)
{
  SoftGripper * gripper = context.world.gripper();
  if (gripper == nullptr) {
    throw RequestError("there is no gripper: start the simulator with --urcap onrobot_soft_gripper");
  }
  const bool stuck = fields.boolean("stuck", gripper->stuck());
  const double object = fields.number("object", {0.0, SoftGripper::max_width}, 0.0);
  fields.reject_unknown();
  gripper->set_stuck(stuck);
  gripper->set_object(object);
  return {{"width", gripper->width()}, {"busy", gripper->busy()}, {"holds_object", gripper->holds_object()}};
}

json robotiq_gripper(ControlPortContext & context, RequestFields & fields)
{
  RobotiqGripper * gripper = context.world.robotiq_gripper();
  if (gripper == nullptr) {
    throw RequestError("there is no Robotiq gripper: start the simulator with --urcap robotiq_gripper");
  }
  const bool stuck = fields.boolean("stuck", gripper->stuck());
  const double object = fields.number("object", {0.0, RobotiqGripper::stroke}, gripper->object_width());
  const double stiffness = fields.number("stiffness", {100.0, 1e9}, 1e9);
  const bool activate = fields.boolean("activate", false);
  const bool has_fault = fields.has("fault");
  const auto fault = static_cast<int>(fields.integer("fault", 0, 15, 0));
  fields.reject_unknown();
  gripper->set_stuck(stuck);
  gripper->set_object(object, stiffness);
  if (activate) {
    gripper->set_active();
  }
  if (has_fault) {
    gripper->set_fault(fault);
  }
  return json::object();
}

json digital_gripper(ControlPortContext & context, RequestFields & fields)
{
  DigitalGripper * gripper = context.world.digital_gripper();
  if (gripper == nullptr) {
    throw RequestError(
        "there is no gripper at the digital outputs: start the simulator with --digital-gripper");
  }
  const bool air = fields.boolean("air", gripper->air());
  const double object = fields.number("object", {0.0, DigitalGripper::stroke}, gripper->object());
  fields.reject_unknown();
  gripper->set_air(air);
  gripper->set_object(object);
  return {{"width", gripper->width()}};
}

constexpr std::array gripper_command_table{
    Command{"gripper", "stuck true|false (unchanged); object mm, 0 none (0)",
            "Makes the soft gripper stick, or places an object of this width between its cups; returns its "
            "width.",
            soft_gripper},
    Command{"robotiq_gripper",
            "stuck true|false (unchanged); object mm, 0 none (unchanged); stiffness N/m of the object (1e9); "
            "fault 0..15, 0 none (unchanged); activate true|false (false)",
            "Makes the Robotiq gripper stick, places an object between its fingers, causes a fault, or activates "
            "the gripper without a motion.",
            robotiq_gripper},
    Command{"digital_gripper", "air true|false (unchanged); object mm, 0 none (unchanged)",
            "Switches the compressed air of the gripper at the digital outputs, or places an object between "
            "its fingers; returns its width.",
            digital_gripper},
};

}  // namespace

std::span<const Command> gripper_commands()
{
  return gripper_command_table;
}

}  // namespace ur_simulator::control_port
