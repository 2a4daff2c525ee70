#include <array>
#include <cmath>
#include <numbers>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

constexpr Range wrench_range{-10000.0, 10000.0};
constexpr Range position_range{-10.0, 10.0};
constexpr std::array<std::string_view, 2> frames{"base", "tool"};

/// The field "wrench", or the field "force" with zero torque.
Vector6 read_wrench(RequestFields & fields)
{
  if (!fields.has("force")) {
    return fields.vector6("wrench", wrench_range);
  }
  Vector6 wrench = Vector6::Zero();
  wrench.head<3>() = fields.vector3("force", wrench_range);
  return wrench;
}

/// Executes a function of the world that has no arguments.
template <void (World::*function)()>
json call_world(ControlPortContext & context, RequestFields & fields)
{
  fields.reject_unknown();
  (context.world.*function)();
  return json::object();
}

json push(ControlPortContext & context, RequestFields & fields)
{
  Push push;
  push.wrench = read_wrench(fields);
  push.duration = fields.number("duration", {0.002, 60.0}, 0.3);
  push.tool_frame = fields.choice("frame", frames, "base") == "tool";
  fields.reject_unknown();
  context.world.push(push);
  return json::object();
}

json place_surface(ControlPortContext & context, RequestFields & fields)
{
  Surface surface;
  if (fields.has("z")) {
    surface.point = Vector3(0.0, 0.0, fields.number("z", position_range));
  } else {
    surface.point = fields.vector3("point", position_range);
  }
  surface.normal = fields.vector3("normal", {-1.0, 1.0}, surface.normal);
  surface.stiffness = fields.number("stiffness", {1.0, 1e7}, surface.stiffness);
  surface.damping = fields.number("damping", {0.0, 1e5}, surface.damping);
  surface.friction = fields.number("friction", {0.0, 10.0}, surface.friction);
  fields.reject_unknown();
  return {{"id", context.world.place_surface(surface)}};
}

json remove_surface(ControlPortContext & context, RequestFields & fields)
{
  const auto id = static_cast<std::uint32_t>(fields.integer("id", 1, 0xffffffff));
  fields.reject_unknown();
  if (!context.world.remove_surface(id)) {
    throw RequestError("field 'id' is " + std::to_string(id) + ": there is no such surface");
  }
  return json::object();
}

json attach_load(ControlPortContext & context, RequestFields & fields)
{
  Payload load;
  load.mass = fields.number("mass", {0.0, 100.0});
  load.center_of_gravity = fields.vector3("center_of_gravity", {-2.0, 2.0}, Vector3(0.0, 0.0, 0.0));
  fields.reject_unknown();
  context.world.attach_load(load);
  return json::object();
}

json set_sensor_noise(ControlPortContext & context, RequestFields & fields)
{
  const double force = fields.number("force", {0.0, 100.0});
  const double torque = fields.number("torque", {0.0, 100.0}, 0.0);
  fields.reject_unknown();
  context.world.set_sensor_noise(force, torque);
  return json::object();
}

json set_joints(ControlPortContext & context, RequestFields & fields)
{
  constexpr double two_turns = 2.0 * std::numbers::pi;
  const Vector6 joints = fields.vector6("joints", {-two_turns, two_turns});
  fields.reject_unknown();
  context.pendant.runner().stop("the joints were set through the control port");
  context.arm.teleport(joints, context.state);
  return json::object();
}

json set_digital_input(ControlPortContext & context, RequestFields & fields)
{
  const std::int64_t number = fields.integer("number", 0, 17);
  const bool value = fields.boolean("value");
  fields.reject_unknown();
  const std::uint64_t bit = std::uint64_t{1} << number;
  std::uint64_t & inputs = context.state.io.digital_inputs;
  inputs = value ? inputs | bit : inputs & ~bit;
  return json::object();
}

json set_analog_input(ControlPortContext & context, RequestFields & fields)
{
  constexpr std::array<std::string_view, 2> domains{"current", "voltage"};
  const auto number = static_cast<std::size_t>(fields.integer("number", 0, 1));
  const bool voltage = fields.choice("domain", domains, "voltage") == "voltage";
  const bool tool = fields.boolean("tool", false);
  const double value = fields.number("value", {0.0, voltage ? 10.0 : 0.02});
  fields.reject_unknown();
  Io & io = context.state.io;
  const std::uint32_t bit = 1u << number;
  std::uint32_t & types = tool ? io.tool_analog_input_types : io.analog_io_types;
  types = voltage ? types | bit : types & ~bit;
  (tool ? io.tool_analog_inputs : io.analog_inputs)[number] = value;
  return json::object();
}

constexpr std::array world_command_table{
    Command{"push", "force [3] N or wrench [6] N, N m; duration s (0.3); frame base|tool (base)",
            "Pushes at the TCP: a half sine with this peak.", push},
    Command{"clear_pushes", "", "Ends all pushes.", call_world<&World::clear_pushes>},
    Command{"place_surface",
            "z m, or point [3] m with normal [3] ([0, 0, 1]); stiffness N/m (20000); damping N s/m (50); "
            "friction (0)",
            "Adds an elastic half space and returns its id.", place_surface},
    Command{"remove_surface", "id", "Removes one surface.", remove_surface},
    Command{"clear_surfaces", "", "Removes all surfaces.", call_world<&World::clear_surfaces>},
    Command{"attach_load", "mass kg; center_of_gravity [3] m in the flange frame ([0, 0, 0])",
            "Sets the actual load at the flange, independent of the payload setting.", attach_load},
    Command{"set_sensor_noise", "force N; torque N m (0)",
            "Sets the standard deviation of the force/torque sensor's noise; 0 switches it off.",
            set_sensor_noise},
    Command{"set_joints", "joints [6] rad",
            "Moves the arm to these joint positions at once and stops the program.", set_joints},
    Command{"set_digital_input", "number 0..17 (8..15 configurable, 16, 17 tool); value true|false",
            "Sets a digital input.", set_digital_input},
    Command{"set_analog_input",
            "number 0|1; value V or A; domain current|voltage (voltage); tool true|false (false)",
            "Sets an analog input.", set_analog_input},
};

}  // namespace

std::span<const Command> world_commands()
{
  return world_command_table;
}

}  // namespace ur_simulator::control_port
