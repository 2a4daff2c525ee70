#include "kinematics/forward_kinematics.hpp"
#include "script_api/robot_context.hpp"
#include "world/world.hpp"

namespace ur_simulator::script_api {

namespace {

// Limits of the script manual ("set_tcp", "set_gravity", "set_target_payload").
constexpr double max_tcp_offset = 10.0;  // m
constexpr double max_gravity = 100.0;    // m/s^2
constexpr double max_inertia = 133.0;    // kg m^2

void check_mass(ArgumentReader & reader, const RobotContext & robot, double mass)
{
  // The controller accepts some overload at reduced speed and rejects more.
  const double max_mass = 2.0 * robot.access.model.payload_max;
  reader.require(mass >= 0.0 && mass <= max_mass,
                 fmt::format("the mass must be in [0, {1}] kg for a {2}, is {0} kg", mass, max_mass,
                             robot.access.model.display_name));
}

Outcome set_payload(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  Payload payload = robot.state().payload;
  payload.mass = reader.number(0, "m");
  check_mass(reader, robot, payload.mass);
  if (reader.given(1)) {
    payload.center_of_gravity = reader.vector3(1, "cog");
  }
  if (!reader) {
    return reader.failure();
  }
  // Without an inertia the payload is a point mass.
  payload.inertia.setZero();
  robot.state().payload = payload;
  return Value();
}

Outcome set_target_payload(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  Payload payload;
  payload.mass = reader.number(0, "m");
  check_mass(reader, robot, payload.mass);
  payload.center_of_gravity = reader.vector3(1, "cog");
  payload.inertia = reader.given(2) ? reader.vector6(2, "inertia") : Vector6(Vector6::Zero());
  reader.require(payload.inertia.cwiseAbs().maxCoeff() <= max_inertia,
                 fmt::format("the inertia must be within {} kg m^2", max_inertia));
  reader.require(payload.inertia.head<3>().minCoeff() >= 0.0, "Ixx, Iyy and Izz must not be negative");
  if (!reader) {
    return reader.failure();
  }
  robot.state().payload = payload;
  robot.access.world.zero_sensor();  // script manual: "automatically zeroed when setting the payload"
  return Value();
}

Outcome set_payload_mass(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double mass = reader.number(0, "m");
  check_mass(reader, robot, mass);
  if (!reader) {
    return reader.failure();
  }
  robot.state().payload.mass = mass;
  return Value();
}

Outcome set_payload_cog(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector3 cog = reader.vector3(0, "cog");
  if (!reader) {
    return reader.failure();
  }
  robot.state().payload.center_of_gravity = cog;
  return Value();
}

Outcome set_tcp(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 pose = reader.pose(0, "pose");
  reader.require(pose.head<3>().cwiseAbs().maxCoeff() <= max_tcp_offset,
                 fmt::format("the TCP offset must be at most {1} m, is {0} m",
                             pose.head<3>().cwiseAbs().maxCoeff(), max_tcp_offset));
  if (!reader) {
    return reader.failure();
  }
  ControllerState & state = robot.state();
  state.tcp_offset = pose;
  // The program reads the pose of the new TCP in this cycle already.
  state.actual_tcp_pose = tcp_pose(robot.access.model, state.actual.position, pose);
  state.measured.tcp_pose = tcp_pose(robot.access.model, state.measured.position, pose);
  state.target_tcp_pose = tcp_pose(robot.access.model, state.target.position, pose);
  return Value();
}

Outcome set_gravity(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector3 gravity = reader.vector3(0, "d");
  reader.require(gravity.norm() <= max_gravity,
                 fmt::format("gravity must be at most {1} m/s^2, is {0} m/s^2", gravity.norm(), max_gravity));
  if (!reader) {
    return reader.failure();
  }
  robot.state().gravity = gravity;
  return Value();
}

/// `sign`: -1 for the deprecated function, which computes torques with the opposite sign (script manual).
template <int sign>
Outcome external_sensor(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  ExternalSensor sensor;
  sensor.enabled = reader.boolean(0, "enable");
  sensor.mass = reader.given(1) ? reader.number(1, "sensor_mass") : 0.0;
  reader.require(sensor.mass >= 0.0, fmt::format("sensor_mass must not be negative, is {} kg", sensor.mass));
  if (reader.given(2)) {
    sensor.measuring_offset = sign * reader.vector3(2, "sensor_measuring_offset");
  }
  if (reader.given(3)) {
    sensor.center_of_gravity = reader.vector3(3, "sensor_cog");
  }
  if (!reader) {
    return reader.failure();
  }
  robot.state().external_sensor = sensor;
  return Value();
}

}  // namespace

void add_installation_builtins(Library & library, const RobotContextPtr & robot)
{
  const urscript::Parameter cog = urscript::Parameter("cog").formerly("CoG");
  add_robot_builtin(library, robot, "set_payload", {"m", cog}, 1, set_payload);
  add_robot_builtin(library, robot, "set_target_payload", {"m", cog, "inertia", "transition_time"}, 2,
                    set_target_payload);
  add_robot_builtin(library, robot, "set_payload_mass", {"m"}, 1, set_payload_mass);
  add_robot_builtin(library, robot, "set_payload_cog", {cog, "transition_time"}, 1, set_payload_cog);
  add_robot_builtin(library, robot, "set_tcp", {"pose", "tcp_name"}, 1, set_tcp);
  add_robot_builtin(library, robot, "set_gravity", {"d"}, 1, set_gravity);
  library.add({"zero_ftsensor", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 robot->access.world.zero_sensor();
                 return Value();
               }});
  const std::vector<urscript::Parameter> sensor{"enable", "sensor_mass", "sensor_measuring_offset",
                                                "sensor_cog"};
  add_robot_builtin(library, robot, "ft_rtde_input_enable", sensor, 1, external_sensor<1>);
  add_robot_builtin(library, robot, "enable_external_ft_sensor", sensor, 1, external_sensor<-1>);
}

}  // namespace ur_simulator::script_api
