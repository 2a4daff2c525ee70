#include "script_api/motion_operation.hpp"
#include "world/world.hpp"

namespace ur_simulator::script_api {

namespace {

std::array<bool, 6> axes_of(ArgumentReader & in, std::size_t index, const char * name)
{
  std::array<bool, 6> axes{};
  const Vector6 values = in.six(index, name);
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    in.require(value == 0.0 || value == 1.0, fmt::format("{}[{}] = {} is neither 0 nor 1", name, i, value));
    axes[i] = value == 1.0;
  }
  return axes;
}

Outcome start(Robot & robot, const CallContext & context, const ForceModeSettings & settings)
{
  if (context.secondary) {
    return Failure{"a secondary program cannot enter force mode"};
  }
  const auto started = robot.access.arm.start_force_mode(settings);
  return started ? Outcome(Value()) : Failure{started.error()};
}

Outcome force_mode(Robot & robot, const CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  ForceModeSettings settings;
  settings.frame = in.pose(0, "task_frame");
  settings.compliant = axes_of(in, 1, "selection_vector");
  settings.wrench = in.six(2, "wrench");
  const std::int32_t type = in.integer(3, "type");
  in.require(type >= 1 && type <= 3, fmt::format("type = {} is outside of 1..3", type));
  settings.limits = in.six(4, "limits");
  if (!in) {
    return in.failure();
  }
  settings.type = static_cast<ForceModeSettings::Type>(type);
  return start(robot, context, settings);
}

// A force along the TCP's z axis, which the tool follows as it turns.
Outcome screw_driving(Robot & robot, const CallContext & context, Arguments arguments)
{
  constexpr double other_axes = 0.1;  // m, rad that they may deviate
  ArgumentReader in(arguments);
  ForceModeSettings settings;
  settings.type = ForceModeSettings::Type::tool;
  settings.compliant[2] = true;
  settings.wrench[2] = in.number(0, "f");
  settings.limits.setConstant(other_axes);
  settings.limits[2] = in.number(1, "v_limit");
  return in ? start(robot, context, settings) : in.failure();
}

Outcome set_damping(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double damping = in.number(0, "damping");
  in.require(damping >= 0.0 && damping <= 1.0, fmt::format("damping = {} is outside of [0, 1]", damping));
  if (!in) {
    return in.failure();
  }
  robot.access.arm.set_force_mode_damping(damping);
  return Value();
}

Outcome set_gain_scaling(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double scaling = in.number(0, "scaling");
  in.require(scaling >= 0.0 && scaling <= 2.0, fmt::format("scaling = {} is outside of [0, 2]", scaling));
  if (!in) {
    return in.failure();
  }
  robot.access.arm.set_force_mode_scaling(scaling);
  return Value();
}

Outcome tool_contact(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 direction = in.six(0, "direction");
  const double threshold = in.number(1, "force_threshold");
  in.require(threshold >= 0.0, fmt::format("force_threshold = {} N is negative", threshold));
  if (!in) {
    return in.failure();
  }
  return Value(static_cast<std::int32_t>(robot.access.world.contact_steps(direction.head<3>(), threshold)));
}

Outcome direct_torque(const RobotPtr & robot, Arguments arguments)
{
  // The manual's defaults of the parts of friction that are compensated.
  constexpr std::array<double, 6> default_viscous{0.9, 0.9, 0.8, 0.9, 0.9, 0.9};
  constexpr std::array<double, 6> default_coulomb{0.8, 0.8, 0.7, 0.8, 0.8, 0.8};
  ArgumentReader in(arguments);
  const Vector6 torque = in.six(0, "torque");
  Vector6 viscous(default_viscous.data());
  Vector6 coulomb(default_coulomb.data());
  // Before 5.25 the second argument told whether friction is compensated at all.
  const bool old_way = in.given(1) && in.value(1).is(urscript::Type::boolean);
  const std::size_t compensate = old_way ? 1 : 3;
  const bool scaled = (in.given(1) && !old_way) || in.given(2);
  if (!scaled && in.given(compensate) && !in.boolean(compensate, "friction_comp")) {
    viscous.setZero();
    coulomb.setZero();
  }
  viscous = in.given(1) && !old_way ? in.six(1, "viscous_scale") : viscous;
  coulomb = in.given(2) ? in.six(2, "coulomb_scale") : coulomb;
  if (!in) {
    return in.failure();
  }
  return begin_motion(robot, [&](Arm & arm) { return arm.direct_torque(torque, viscous, coulomb); });
}

}  // namespace

void add_force_builtins(Library & library, const RobotPtr & robot)
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
  add_bound(library, robot, "force_mode_set_damping", {"damping"}, 1, set_damping);
  add_bound(library, robot, "force_mode_set_gain_scaling", {"scaling"}, 1, set_gain_scaling);
  add_bound(library, robot, "tool_contact",
            {{"direction", Value::list(Vector6(Vector6::Zero()))}, {"force_threshold", Value(0.0)}}, 0,
            tool_contact, 60);
  library.add({"direct_torque",
               {"torque", "viscous_scale", "coulomb_scale", "friction_comp"},
               1,
               [robot](CallContext &, Arguments arguments) { return direct_torque(robot, arguments); },
               false,
               300});
}

}  // namespace ur_simulator::script_api
