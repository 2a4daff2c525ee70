#include <fmt/format.h>

#include <array>
#include <numbers>
#include <optional>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;
using std::numbers::pi;

constexpr Range wrench_range{-10000.0, 10000.0};
constexpr Range position_range{-10.0, 10.0};
constexpr Range joint_range{-1000.0, 1000.0};  // wrist 3 of a UR3e is endless
constexpr std::array<std::string_view, 2> frames{"base", "tool"};

// The kinds of objects, as functions of the world.
constexpr ObjectList<Surface> & (World::*surfaces)() = &World::surfaces;
constexpr ObjectList<Box> & (World::*boxes)() = &World::boxes;
constexpr ObjectList<Spring> & (World::*springs)() = &World::springs;

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

Elasticity read_elasticity(RequestFields & fields)
{
  Elasticity elasticity;
  elasticity.stiffness = fields.number("stiffness", {1.0, 1e7}, elasticity.stiffness);
  elasticity.damping = fields.number("damping", {0.0, 1e5}, elasticity.damping);
  elasticity.friction = fields.number("friction", {0.0, 10.0}, elasticity.friction);
  return elasticity;
}

Action push(RequestFields & fields)
{
  Push push;
  push.wrench = read_wrench(fields);
  push.duration = fields.number("duration", {0.002, 60.0}, 0.3);
  push.tool_frame = fields.choice("frame", frames, "base") == "tool";
  return [=](ControlPortContext & context) -> json {
    context.world.push(push);
    return json::object();
  };
}

Action clear_pushes(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    context.world.clear_pushes();
    return json::object();
  };
}

Action place_surface(RequestFields & fields)
{
  Surface surface;
  if (fields.has("z")) {
    surface.point = Vector3(0.0, 0.0, fields.number("z", position_range));
  } else {
    surface.point = fields.vector3("point", position_range);
  }
  surface.normal = fields.vector3("normal", {-1.0, 1.0}, surface.normal);
  if (surface.normal.norm() < 1e-9) {
    throw RequestError("field 'normal' is [0, 0, 0]: it must be a direction", "normal");
  }
  surface.elasticity = read_elasticity(fields);
  return
      [=](ControlPortContext & context) -> json { return {{"id", context.world.surfaces().add(surface)}}; };
}

Action place_box(RequestFields & fields)
{
  Box box;
  box.center = fields.vector3("center", position_range);
  box.size = fields.vector3("size", {1e-3, 20.0});
  box.rotation = fields.vector3("rotation", {-2.0 * pi, 2.0 * pi}, box.rotation);
  box.elasticity = read_elasticity(fields);
  return [=](ControlPortContext & context) -> json { return {{"id", context.world.boxes().add(box)}}; };
}

Action attach_spring(RequestFields & fields)
{
  Spring spring;
  spring.anchor = fields.vector3("anchor", position_range);
  spring.stiffness = fields.number("stiffness", {0.0, 1e5});
  spring.damping = fields.number("damping", {0.0, 1e4}, spring.damping);
  spring.length = fields.number("length", {0.0, 10.0}, spring.length);
  return [=](ControlPortContext & context) -> json { return {{"id", context.world.springs().add(spring)}}; };
}

/// Removes one of the objects of a kind.
template <auto objects>
Action remove_object(RequestFields & fields)
{
  const auto id = static_cast<std::uint32_t>(fields.integer("id", 1, 0xffffffff));
  return [=](ControlPortContext & context) -> json {
    if (!(context.world.*objects)().remove(id)) {
      throw RequestError("field 'id' is " + std::to_string(id) + ": there is no such object", "id");
    }
    return json::object();
  };
}

/// Removes all objects of a kind.
template <auto objects>
Action clear_objects(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    (context.world.*objects)().clear();
    return json::object();
  };
}

Action attach_load(RequestFields & fields)
{
  Payload load;
  load.mass = fields.number("mass", {0.0, 100.0});
  load.center_of_gravity = fields.vector3("center_of_gravity", {-2.0, 2.0}, Vector3(0.0, 0.0, 0.0));
  return [=](ControlPortContext & context) -> json {
    context.world.attach_load(load);
    return json::object();
  };
}

Action set_sensor_noise(RequestFields & fields)
{
  const double force = fields.number("force", {0.0, 100.0});
  const double torque = fields.number("torque", {0.0, 100.0}, 0.0);
  return [=](ControlPortContext & context) -> json {
    context.world.set_sensor_noise(force, torque);
    return json::object();
  };
}

void require_within_limits(const RobotModel & model, const Vector6 & joints)
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (joints[i] < model.position_min[i] || joints[i] > model.position_max[i]) {
      throw RequestError(fmt::format("field 'joints[{}]' is {}: it must be between {} and {} rad", i,
                                     joints[i], model.position_min[i], model.position_max[i]),
                         "joints");
    }
  }
}

Action set_joints(RequestFields & fields)
{
  const Vector6 joints = fields.vector6("joints", joint_range);
  return [=](ControlPortContext & context) -> json {
    require_within_limits(context.pendant.model(), joints);
    context.pendant.runner().stop("the joints were set through the control port");
    context.arm.teleport(joints, context.state);
    context.collisions.reset();
    return json::object();
  };
}

Action set_digital_input(RequestFields & fields)
{
  const std::int64_t number = fields.integer("number", 0, 17);
  const bool value = fields.boolean("value");
  return [=](ControlPortContext & context) -> json {
    const std::uint64_t bit = std::uint64_t{1} << number;
    std::uint64_t & inputs = context.state.io.digital_inputs;
    inputs = value ? inputs | bit : inputs & ~bit;
    return json::object();
  };
}

Action set_analog_input(RequestFields & fields)
{
  constexpr std::array<std::string_view, 2> domains{"current", "voltage"};
  const auto number = static_cast<std::size_t>(fields.integer("number", 0, 1));
  const bool voltage = fields.choice("domain", domains, "voltage") == "voltage";
  const bool tool = fields.boolean("tool", false);
  const double value = fields.number("value", {0.0, voltage ? 10.0 : 0.02});
  return [=](ControlPortContext & context) -> json {
    Io & io = context.state.io;
    const std::uint32_t bit = 1u << number;
    std::uint32_t & types = tool ? io.tool_analog_input_types : io.analog_io_types;
    types = voltage ? types | bit : types & ~bit;
    (tool ? io.tool_analog_inputs : io.analog_inputs)[number] = value;
    return json::object();
  };
}

constexpr std::array world_command_table{
    Command{"push", "force [3] N or wrench [6] N, N m; duration s (0.3); frame base|tool (base)",
            "Pushes at the TCP: a half sine with this peak.", push},
    Command{"clear_pushes", "", "Ends all pushes.", clear_pushes},
    Command{"place_surface",
            "z m, or point [3] m with normal [3] ([0, 0, 1]); stiffness N/m (20000); damping N s/m (50); "
            "friction (0)",
            "Adds an elastic half space and returns its id.", place_surface},
    Command{"remove_surface", "id", "Removes one surface.", remove_object<surfaces>},
    Command{"clear_surfaces", "", "Removes all surfaces.", clear_objects<surfaces>},
    Command{"place_box",
            "center [3] m; size [3] m; rotation [3] rotation vector rad ([0, 0, 0]); stiffness N/m (20000); "
            "damping N s/m (50); friction (0)",
            "Adds an elastic box and returns its id.", place_box},
    Command{"remove_box", "id", "Removes one box.", remove_object<boxes>},
    Command{"clear_boxes", "", "Removes all boxes.", clear_objects<boxes>},
    Command{"attach_spring", "anchor [3] m; stiffness N/m; damping N s/m (0); length m (0)",
            "Connects the TCP to a fixed point by a spring of this unloaded length and returns its id.",
            attach_spring},
    Command{"remove_spring", "id", "Removes one spring.", remove_object<springs>},
    Command{"clear_springs", "", "Removes all springs.", clear_objects<springs>},
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
