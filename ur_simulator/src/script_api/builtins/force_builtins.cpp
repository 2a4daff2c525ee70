#include "script_api/motion_operation.hpp"
#include "world/world.hpp"

namespace ur_simulator::script_api {

namespace {

Outcome start(RobotContext & robot, const CallContext & context, const ForceModeSettings & settings)
{
  if (context.secondary) {
    return Failure{"a secondary program cannot enter force mode"};
  }
  const auto started = robot.access.arm.start_force_mode(settings);
  return started ? Outcome(Value()) : Failure{started.error()};
}

Outcome force_mode(RobotContext & robot, const CallContext & context, Arguments arguments)
{
  ArgumentReader reader(arguments);
  ForceModeSettings settings;
  settings.frame = reader.pose(0, "task_frame");
  settings.compliant = reader.selection(1, "selection_vector");
  settings.wrench = reader.vector6(2, "wrench");
  const std::int32_t type = reader.integer(3, "type");
  reader.require(type >= 1 && type <= 3, fmt::format("type must be in [1, 3], is {}", type));
  settings.limits = reader.vector6(4, "limits");
  if (!reader) {
    return reader.failure();
  }
  settings.type = static_cast<ForceModeSettings::Type>(type);
  return start(robot, context, settings);
}

// Force mode along the z axis of the TCP.
Outcome screw_driving(RobotContext & robot, const CallContext & context, Arguments arguments)
{
  constexpr double max_deviation = 0.1;  // m, rad, of the other axes
  ArgumentReader reader(arguments);
  ForceModeSettings settings;
  settings.type = ForceModeSettings::Type::tool;
  settings.compliant[2] = true;
  settings.wrench[2] = reader.number(0, "f");
  settings.limits.setConstant(max_deviation);
  settings.limits[2] = reader.number(1, "v_limit");
  return reader ? start(robot, context, settings) : reader.failure();
}

Outcome set_damping(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double damping = reader.number(0, "damping");
  reader.require(damping >= 0.0 && damping <= 1.0, fmt::format("damping must be in [0, 1], is {}", damping));
  if (!reader) {
    return reader.failure();
  }
  robot.access.arm.set_force_mode_damping(damping);
  return Value();
}

Outcome set_gain_scaling(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double scaling = reader.number(0, "scaling");
  reader.require(scaling >= 0.0 && scaling <= 2.0, fmt::format("scaling must be in [0, 2], is {}", scaling));
  if (!reader) {
    return reader.failure();
  }
  robot.access.arm.set_force_mode_scaling(scaling);
  return Value();
}

Outcome tool_contact(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 direction = reader.vector6(0, "direction");
  const double threshold = reader.number(1, "force_threshold");
  reader.require(threshold >= 0.0, fmt::format("force_threshold must not be negative, is {} N", threshold));
  if (!reader) {
    return reader.failure();
  }
  return Value(
      static_cast<std::int32_t>(robot.access.world.cycles_since_contact(direction.head<3>(), threshold)));
}

Outcome direct_torque(const RobotContextPtr & robot, Arguments arguments)
{
  // Defaults of the script manual ("direct_torque").
  constexpr std::array<double, 6> default_viscous{0.9, 0.9, 0.8, 0.9, 0.9, 0.9};
  constexpr std::array<double, 6> default_coulomb{0.8, 0.8, 0.7, 0.8, 0.8, 0.8};
  ArgumentReader reader(arguments);
  const Vector6 torque = reader.vector6(0, "torque");
  Vector6 viscous(default_viscous.data());
  Vector6 coulomb(default_coulomb.data());
  // Before PolyScope 5.25 the second argument was the boolean friction_comp.
  const bool legacy_signature = reader.given(1) && reader.value(1).is(urscript::Type::boolean);
  const std::size_t compensate = legacy_signature ? 1 : 3;
  const bool scaled = (reader.given(1) && !legacy_signature) || reader.given(2);
  if (!scaled && reader.given(compensate) && !reader.boolean(compensate, "friction_comp")) {
    viscous.setZero();
    coulomb.setZero();
  }
  viscous = reader.given(1) && !legacy_signature ? reader.vector6(1, "viscous_scale") : viscous;
  coulomb = reader.given(2) ? reader.vector6(2, "coulomb_scale") : coulomb;
  if (!reader) {
    return reader.failure();
  }
  return start_motion(robot, [&](Arm & arm) { return arm.direct_torque(torque, viscous, coulomb); });
}

}  // namespace

void add_force_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add({"force_mode",
               {"task_frame", "selection_vector", "wrench", "type", "limits"},
               5,
               [robot](CallContext & context, Arguments arguments) {
                 return force_mode(*robot, context, arguments);
               }});
  library.add({"screw_driving", {"f", "v_limit"}, 2, [robot](CallContext & context, Arguments arguments) {
                 return screw_driving(*robot, context, arguments);
               }});
  for (const char * name : {"end_force_mode", "end_screw_driving"}) {
    library.add({name, {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                   robot->access.arm.end_force_mode();
                   return Value();
                 }});
  }
  add_robot_builtin(library, robot, "force_mode_set_damping", {"damping"}, 1, set_damping);
  add_robot_builtin(library, robot, "force_mode_set_gain_scaling", {"scaling"}, 1, set_gain_scaling);
  library.add({"force_mode_get_damping", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value(robot->access.arm.force_mode_damping());
               }});
  library.add({"force_mode_get_gain_scaling", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value(robot->access.arm.force_mode_scaling());
               }});
  add_robot_builtin(library, robot, "tool_contact",
                    {{"direction", Value::list(Vector6(Vector6::Zero()))}, {"force_threshold", Value(0.0)}},
                    0, tool_contact, 60);
  library.add(
      {"direct_torque",
       {urscript::Parameter("torque").formerly("torques"), "viscous_scale", "coulomb_scale", "friction_comp"},
       1,
       [robot](CallContext &, Arguments arguments) { return direct_torque(robot, arguments); },
       false,
       300});
}

}  // namespace ur_simulator::script_api
