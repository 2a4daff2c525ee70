#include <array>
#include <optional>
#include <string>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

/// Empty: not given.
std::optional<bool> optional_boolean(RequestFields & fields, const std::string & name)
{
  return fields.has(name) ? std::optional(fields.boolean(name)) : std::nullopt;
}

/// mm; empty: not given.
std::optional<double> optional_width(RequestFields & fields, const std::string & name, double max)
{
  return fields.has(name) ? std::optional(fields.number(name, {0.0, max})) : std::nullopt;
}

template <typename Gripper>
Gripper & installed(Gripper * gripper, const char * otherwise)
{
  if (gripper == nullptr) {
    throw RequestError(otherwise);
  }
  return *gripper;
}

Action soft_gripper(RequestFields & fields)
{
  const auto stuck = optional_boolean(fields, "stuck");
  const auto powered = optional_boolean(fields, "powered");
  const double object = fields.number("object", {0.0, SoftGripper::max_width}, 0.0);
  return [=](ControlPortContext & context) -> json {
    SoftGripper & gripper =
        installed(context.world.gripper(),
                  "there is no gripper: start the simulator with --urcap onrobot_soft_gripper");
    gripper.set_stuck(stuck.value_or(gripper.is_stuck()));
    gripper.set_powered(powered.value_or(gripper.is_powered()));
    gripper.set_object(object);
    return {
        {"width", gripper.width()}, {"busy", gripper.is_busy()}, {"holds_object", gripper.holds_object()}};
  };
}

Action robotiq_gripper(RequestFields & fields)
{
  const auto stuck = optional_boolean(fields, "stuck");
  const auto object = optional_width(fields, "object", RobotiqGripper::stroke);
  const double stiffness = fields.number("stiffness", {100.0, 1e9}, 1e9);
  const bool activate = fields.boolean("activate", false);
  const auto fault = fields.has("fault") ? std::optional(fields.integer("fault", 0, 15)) : std::nullopt;
  return [=](ControlPortContext & context) -> json {
    RobotiqGripper & gripper =
        installed(context.world.robotiq_gripper(),
                  "there is no Robotiq gripper: start the simulator with --urcap robotiq_gripper");
    gripper.set_stuck(stuck.value_or(gripper.is_stuck()));
    gripper.set_object(object.value_or(gripper.object_width()), stiffness);
    if (activate) {
      gripper.set_active();
    }
    if (fault) {
      gripper.set_fault(static_cast<int>(*fault));
    }
    return json::object();
  };
}

Action digital_gripper(RequestFields & fields)
{
  const auto air = optional_boolean(fields, "air");
  const auto object = optional_width(fields, "object", DigitalGripper::stroke);
  return [=](ControlPortContext & context) -> json {
    DigitalGripper & gripper =
        installed(context.world.digital_gripper(),
                  "there is no gripper at the digital outputs: start the simulator with --digital-gripper");
    gripper.set_air(air.value_or(gripper.air()));
    gripper.set_object(object.value_or(gripper.object()));
    return {{"width", gripper.width()}};
  };
}

constexpr std::array gripper_command_table{
    Command{"gripper", "stuck, powered true|false (unchanged); object mm, 0 none (0)",
            "Makes the soft gripper stick, switches its power, or places an object of this width between its "
            "cups; returns its width.",
            soft_gripper},
    Command{
        "robotiq_gripper",
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
