#include "kinematics/inverse.hpp"
#include "motion/arm.hpp"
#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

// Dexterity below which get_freedrive_status() warns; not published.
constexpr double near_singularity = 0.2;
constexpr double too_near_singularity = 0.1;

std::array<bool, 6> free_axes(ArgumentReader & in)
{
  std::array<bool, 6> axes;
  axes.fill(true);
  if (!in.given(0)) {
    return axes;
  }
  const Vector6 values = in.six(0, "freeAxes");
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    in.require(value == 0.0 || value == 1.0, fmt::format("freeAxes[{}] = {} is neither 0 nor 1", i, value));
    axes[i] = value == 1.0;
  }
  return axes;
}

/// A pose, or one of the frames that have a name.
Vector6 feature(const Robot & robot, ArgumentReader & in)
{
  if (!in.given(1)) {
    return Vector6::Zero();
  }
  if (!in.value(1).is(urscript::Type::string)) {
    return in.pose(1, "feature");
  }
  const std::string name = in.string(1, "feature");
  in.require(name == "base" || name == "tool",
             fmt::format("feature \"{}\" is neither \"base\" nor \"tool\" nor a pose", name));
  return name == "tool" ? robot.state().actual_tcp_pose : Vector6(Vector6::Zero());
}

Outcome guide(Robot & robot, const CallContext & context, const std::array<bool, 6> & axes,
              const Vector6 & frame)
{
  if (context.secondary) {
    return Failure{"a secondary program cannot enter freedrive"};
  }
  if (robot.moving != nullptr) {
    return Failure{"Another thread is already controlling the robot"};
  }
  const MotionStart started = robot.access.arm.freedrive(axes, frame);
  return started ? Outcome(Value()) : Failure{started.error()};
}

Outcome freedrive_mode(Robot & robot, const CallContext & context, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::array<bool, 6> axes = free_axes(in);
  const Vector6 frame = feature(robot, in);
  return in ? guide(robot, context, axes, frame) : in.failure();
}

Outcome teach_mode(Robot & robot, const CallContext & context)
{
  std::array<bool, 6> axes;
  axes.fill(true);
  return guide(robot, context, axes, Vector6::Zero());
}

Outcome freedrive_status(Robot & robot, Arguments)
{
  const double freedom = dexterity(robot.access.model, robot.state().actual.position);
  return Value(freedom < too_near_singularity ? 2 : freedom < near_singularity ? 1 : 0);
}

}  // namespace

void add_hand_guiding_builtins(Library & library, const RobotPtr & robot)
{
  library.add(
      {"freedrive_mode", {"freeAxes", "feature"}, 0, [robot](CallContext & context, Arguments arguments) {
         return freedrive_mode(*robot, context, arguments);
       }});
  library.add({"teach_mode", {}, 0, [robot](CallContext & context, Arguments) {
                 return teach_mode(*robot, context);
               }});
  for (const char * name : {"end_freedrive_mode", "end_teach_mode"}) {
    library.add({name, {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                   robot->access.arm.end_freedrive();
                   return Value();
                 }});
  }
  add_bound(library, robot, "get_freedrive_status", {}, 0, freedrive_status);
}

}  // namespace ur_simulator::script_api
