#include "script_api/motion_operation.hpp"

// path_offset_…(): offsets of the TCP that are superposed on the motion of the program.

namespace ur_simulator::script_api {

namespace {

PathOffset::Frame offset_frame(ArgumentReader & reader, std::size_t i)
{
  const int type = reader.integer(i, "type");
  reader.require(type >= 1 && type <= 4,
                 fmt::format("type must be 1 (base), 2 (TCP), 3 (motion) or 4 (world), is {}", type));
  return static_cast<PathOffset::Frame>(type);
}

Outcome enable(RobotContext & robot, Arguments)
{
  robot.access.arm.path_offset().enable();
  return Value();
}

Outcome set(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 offset = reader.vector6(0, "offset");
  const PathOffset::Frame frame = offset_frame(reader, 1);
  if (!reader) {
    return reader.failure();
  }
  robot.access.arm.path_offset().set(offset, frame);
  return Value();
}

Outcome get(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const PathOffset::Frame frame = offset_frame(reader, 0);
  return reader ? Outcome(Value::pose(robot.access.arm.path_offset().get(frame))) : reader.failure();
}

Outcome set_alpha_filter(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double alpha = reader.number(0, "alpha");
  reader.require(alpha >= 0.0 && alpha <= 1.0, fmt::format("alpha must be between 0 and 1, is {}", alpha));
  if (!reader) {
    return reader.failure();
  }
  robot.access.arm.path_offset().set_filter(alpha);
  return Value();
}

Outcome set_max_offset(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double translation = reader.number(0, "transLimit");
  const double rotation = reader.number(1, "rotLimit");
  reader.require(translation >= 0.0, fmt::format("transLimit must not be negative, is {}", translation));
  reader.require(rotation >= 0.0, fmt::format("rotLimit must not be negative, is {}", rotation));
  if (!reader) {
    return reader.failure();
  }
  robot.access.arm.path_offset().set_limits(translation, rotation);
  return Value();
}

Outcome disable(const RobotContextPtr & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double deceleration = reader.number(0, "a");
  reader.require(deceleration > 0.0, fmt::format("a must be greater than 0, is {}", deceleration));
  if (!reader) {
    return reader.failure();
  }
  return start_motion(robot, [deceleration](Arm & arm) {
    arm.disable_path_offset();
    return arm.stop_joint(deceleration);
  });
}

}  // namespace

void add_path_offset_builtins(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "path_offset_enable", {}, 0, enable);
  add_robot_builtin(library, robot, "path_offset_set", {"offset", "type"}, 2, set);
  add_robot_builtin(library, robot, "path_offset_get", {"type"}, 1, get);
  add_robot_builtin(library, robot, "path_offset_set_alpha_filter", {"alpha"}, 1, set_alpha_filter);
  add_robot_builtin(library, robot, "path_offset_set_max_offset", {"transLimit", "rotLimit"}, 2,
                    set_max_offset);
  library.add({"path_offset_disable", {{"a", Value(20.0)}}, 0, [robot](CallContext &, Arguments arguments) {
                 return disable(robot, arguments);
               }});
}

}  // namespace ur_simulator::script_api
