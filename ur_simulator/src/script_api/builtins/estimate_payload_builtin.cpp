#include <numbers>

#include "common/pose.hpp"
#include "dynamics/load_estimation.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "script_api/robot_context.hpp"
#include "world/force_torque_sensor.hpp"

namespace ur_simulator::script_api {

namespace {

constexpr std::size_t min_poses = 4;
constexpr std::size_t max_poses = 100;

/// Six numbers, as a list or a pose.
struct Element {
  Vector6 values;
  bool is_pose;
};

/// The elements of a list; the interpreter stores a list of lists of numbers as a matrix.
std::vector<Element> elements(Arguments arguments, ArgumentReader & reader, std::size_t i, const char * name)
{
  std::vector<Element> result;
  const Value & value = arguments[i];
  if (value.is(urscript::Type::matrix) && value.matrix().columns == 6) {
    for (std::size_t row = 0; row < value.matrix().rows; ++row) {
      result.push_back({Vector6(&value.matrix().elements[row * 6]), false});
    }
  } else if (value.is(urscript::Type::list)) {
    for (const Value & element : value.list()) {
      const auto values = element.vector6();
      if (!values || !is_finite(*values)) {
        reader.require(false,
                       fmt::format("{}[{}] must be a pose or a list of six numbers", name, result.size()));
        return {};
      }
      result.push_back({*values, element.is(urscript::Type::pose)});
    }
  } else {
    reader.require(false,
                   fmt::format("the argument '{}' must be a list of poses or of lists of six numbers", name));
  }
  return result;
}

/// Poses of the flange in the base frame, from those of the TCP or joint positions.
std::vector<Transform> flange_poses(const RobotContext & robot, const std::vector<Element> & poses)
{
  const Transform tcp_to_flange = to_transform(robot.state().tcp_offset).inverse();
  std::vector<Transform> result;
  for (const auto & [values, is_pose] : poses) {
    result.push_back(is_pose ? Transform(to_transform(values) * tcp_to_flange)
                             : flange_pose(robot.access.model, values));
  }
  return result;
}

void require_different_orientations(const std::vector<Transform> & poses, ArgumentReader & reader)
{
  const double min_angle = std::numbers::pi / (2.0 * static_cast<double>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double angle = to_rotation_vector(poses[k].linear().transpose() * poses[i].linear()).norm();
      if (angle < min_angle) {
        return reader.require(
            false, fmt::format("the orientations of poses[{}] and poses[{}] differ by {:.3f} rad: it must be "
                               "at least {:.3f} rad",
                               k, i, angle, min_angle));
      }
    }
  }
}

/// `wrench`: as get_tcp_force() returns it.
LoadMeasurement load_measurement(const RobotContext & robot, const Transform & flange, const Vector6 & wrench)
{
  const ControllerState & state = robot.state();
  const Eigen::Matrix3d to_flange = flange.linear().transpose();
  const Vector3 flange_to_tcp = flange.linear() * state.tcp_offset.head<3>();
  const bool is_at_flange = reports_force_at_flange(robot.access.model, state);
  return {to_flange * state.gravity,
          rotate_spatial_vector(to_flange, is_at_flange ? wrench : shift_wrench(wrench, flange_to_tcp))};
}

// The wrenches are those that the active payload does not explain.
Value payload_of(const Payload & active, const LoadEstimate & unexplained)
{
  const double mass = active.mass + unexplained.mass;
  const Vector3 moment = active.mass * active.center_of_gravity + unexplained.moment;
  const bool loaded = mass > 0.0;
  urscript::Structure result;
  result.members.emplace_back("mass", Value(loaded ? mass : 0.0));
  result.members.emplace_back("cog", Value::list(loaded ? Vector3(moment / mass) : Vector3(Vector3::Zero())));
  return Value(std::move(result));
}

Outcome estimate_payload(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::vector<Element> positions = elements(arguments, reader, 0, "poses");
  const std::vector<Element> wrenches = elements(arguments, reader, 1, "wrenches");
  reader.require(
      positions.size() >= min_poses && positions.size() <= max_poses,
      fmt::format("poses must have {} to {} elements, not {}", min_poses, max_poses, positions.size()));
  reader.require(wrenches.size() == positions.size(),
                 fmt::format("wrenches must have as many elements as poses: {}, not {}", positions.size(),
                             wrenches.size()));
  const std::vector<Transform> poses = flange_poses(robot, positions);
  if (reader) {
    require_different_orientations(poses, reader);
  }
  if (!reader) {
    return reader.failure();
  }
  std::vector<LoadMeasurement> measurements;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    measurements.push_back(load_measurement(robot, poses[i], wrenches[i].values));
  }
  const auto load = estimate_load(measurements);
  return load ? Outcome(payload_of(robot.state().payload, *load))
              : Failure{"the poses do not determine the payload: tilt the flange about two axes"};
}

}  // namespace

void add_estimate_payload_builtin(Library & library, const RobotContextPtr & robot)
{
  add_robot_builtin(library, robot, "estimate_payload", {"poses", "wrenches"}, 2, estimate_payload, 2000);
}

}  // namespace ur_simulator::script_api
