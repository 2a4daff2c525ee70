#include "kinematics/forward.hpp"
#include "script_api/robot.hpp"
#include "world/world.hpp"

namespace ur_simulator::script_api {

namespace {

// The manual's limits of the arguments.
constexpr double largest_offset = 10.0;         // m
constexpr double largest_acceleration = 100.0;  // m/s^2

void check_mass(ArgumentReader & in, const Robot & robot, double mass)
{
  // The controller accepts some overload, at reduced speed; far beyond it refuses.
  const double most = 2.0 * robot.access.model.payload_max;
  in.require(mass >= 0.0 && mass <= most, fmt::format("the mass {} kg is outside of [0, {}] kg of a {}", mass,
                                                      most, robot.access.model.display_name));
}

Outcome set_payload(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  Payload payload = robot.state().payload;
  payload.mass = in.number(0, "m");
  check_mass(in, robot, payload.mass);
  if (in.given(1)) {
    payload.center_of_gravity = in.three(1, "cog");
  }
  if (!in) {
    return in.failure();
  }
  // Without inertia given the controller takes the payload as a point mass.
  payload.inertia.setZero();
  robot.state().payload = payload;
  return Value();
}

Outcome set_target_payload(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  Payload payload;
  payload.mass = in.number(0, "m");
  check_mass(in, robot, payload.mass);
  payload.center_of_gravity = in.three(1, "cog");
  payload.inertia = in.given(2) ? in.six(2, "inertia") : Vector6(Vector6::Zero());
  if (!in) {
    return in.failure();
  }
  robot.state().payload = payload;
  return Value();
}

Outcome set_payload_mass(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const double mass = in.number(0, "m");
  check_mass(in, robot, mass);
  if (!in) {
    return in.failure();
  }
  robot.state().payload.mass = mass;
  return Value();
}

Outcome set_payload_cog(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector3 cog = in.three(0, "CoG");
  if (!in) {
    return in.failure();
  }
  robot.state().payload.center_of_gravity = cog;
  return Value();
}

Outcome set_tcp(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector6 pose = in.pose(0, "pose");
  in.require(pose.head<3>().cwiseAbs().maxCoeff() <= largest_offset,
             fmt::format("a TCP offset of {} m is beyond {} m", pose.head<3>().cwiseAbs().maxCoeff(),
                         largest_offset));
  if (!in) {
    return in.failure();
  }
  ControllerState & state = robot.state();
  state.tcp_offset = pose;
  // What the program reads in this cycle is already of the new TCP.
  state.actual_tcp_pose = forward_tcp(robot.access.model, state.actual.position, pose);
  state.target_tcp_pose = forward_tcp(robot.access.model, state.target.position, pose);
  return Value();
}

Outcome set_gravity(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const Vector3 gravity = in.three(0, "d");
  in.require(gravity.norm() <= largest_acceleration,
             fmt::format("a gravity of {} m/s^2 is beyond {} m/s^2", gravity.norm(), largest_acceleration));
  if (!in) {
    return in.failure();
  }
  robot.state().gravity = gravity;
  return Value();
}

Outcome external_sensor(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  ExternalSensor sensor;
  sensor.enabled = in.boolean(0, "enable");
  sensor.mass = in.given(1) ? in.number(1, "sensor_mass") : 0.0;
  in.require(sensor.mass >= 0.0, fmt::format("sensor_mass = {} kg is negative", sensor.mass));
  if (in.given(2)) {
    sensor.measuring_offset = in.three(2, "sensor_measuring_offset");
  }
  if (in.given(3)) {
    sensor.center_of_gravity = in.three(3, "sensor_cog");
  }
  if (!in) {
    return in.failure();
  }
  robot.state().external_sensor = sensor;
  return Value();
}

}  // namespace

void add_installation_builtins(Library & library, const RobotPtr & robot)
{
  add_bound(library, robot, "set_payload", {"m", "cog"}, 1, set_payload);
  add_bound(library, robot, "set_target_payload", {"m", "cog", "inertia", "transition_time"}, 2,
            set_target_payload);
  add_bound(library, robot, "set_payload_mass", {"m"}, 1, set_payload_mass);
  add_bound(library, robot, "set_payload_cog", {"CoG", "transition_time"}, 1, set_payload_cog);
  add_bound(library, robot, "set_tcp", {"pose", "tcp_name"}, 1, set_tcp);
  add_bound(library, robot, "set_gravity", {"d"}, 1, set_gravity);
  library.add({"zero_ftsensor", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 robot->access.world.zero_sensor();
                 return Value();
               }});
  for (const char * name : {"enable_external_ft_sensor", "ft_rtde_input_enable"}) {
    add_bound(library, robot, name, {"enable", "sensor_mass", "sensor_measuring_offset", "sensor_cog"}, 1,
              external_sensor);
  }
}

}  // namespace ur_simulator::script_api
