#include "common/pose.hpp"
#include "urscript/argument_reader.hpp"
#include "urscript/builtins/builtins.hpp"

namespace ur_simulator::urscript {

namespace {

Vector6 joined(const Vector3 & upper, const Vector3 & lower)
{
  Vector6 result;
  result << upper, lower;
  return result;
}

// Adds the positions and composes the rotations.
Outcome pose_add(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 a = reader.pose(0, "p_1");
  const Vector6 b = reader.pose(1, "p_2");
  const Eigen::Matrix3d rotation = to_rotation_matrix(a.tail<3>()) * to_rotation_matrix(b.tail<3>());
  return reader ? Outcome(Value::pose(joined(a.head<3>() + b.head<3>(), to_rotation_vector(rotation))))
                : reader.failure();
}

// The displacement from p_from to p_to; position and rotation in the base frame: pose_add(pose_sub(a, b), b)
// == a.
Vector6 difference(const Vector6 & to, const Vector6 & from)
{
  const Eigen::Matrix3d rotation =
      to_rotation_matrix(to.tail<3>()) * to_rotation_matrix(from.tail<3>()).transpose();
  return joined(to.head<3>() - from.head<3>(), to_rotation_vector(rotation));
}

Outcome pose_sub(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 to = reader.pose(0, "p_to");
  const Vector6 from = reader.pose(1, "p_from");
  return reader ? Outcome(Value::pose(difference(to, from))) : reader.failure();
}

Outcome pose_trans_builtin(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 from = reader.pose(0, "p_from");
  const Vector6 to = reader.pose(1, "p_from_to");
  return reader ? Outcome(Value::pose(pose_trans(from, to))) : reader.failure();
}

Outcome pose_inv_builtin(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 from = reader.pose(0, "p_from");
  return reader ? Outcome(Value::pose(pose_inv(from))) : reader.failure();
}

Outcome pose_dist(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double distance = difference(reader.pose(1, "p_to"), reader.pose(0, "p_from")).norm();
  return reader ? Outcome(Value(distance)) : reader.failure();
}

Outcome point_dist(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 from = reader.pose(0, "p_from");
  const Vector6 to = reader.pose(1, "p_to");
  return reader ? Outcome(Value((to - from).head<3>().norm())) : reader.failure();
}

Outcome interpolate(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector6 from = reader.pose(0, "p_from");
  const Vector6 to = reader.pose(1, "p_to");
  const double alpha = reader.number(2, "alpha");
  return reader ? Outcome(Value::pose(interpolate_pose(from, to, alpha))) : reader.failure();
}

// Roll, pitch and yaw are rotations about the fixed axes X, Y and Z, in this order.
Outcome rpy2rotvec(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector3 rpy = reader.vector3(0, "rpy_vector");
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Vector3::UnitX()))
          .toRotationMatrix();
  return reader ? Outcome(Value::list(to_rotation_vector(rotation))) : reader.failure();
}

Outcome rotvec2rpy(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Eigen::Matrix3d r = to_rotation_matrix(reader.vector3(0, "rotation_vector"));
  const double pitch = std::atan2(-r(2, 0), r.col(0).head<2>().norm());
  // Gimbal lock at pitch +-90 degrees: yaw is 0, roll takes the whole rotation.
  const bool locked = r.col(0).head<2>().norm() < 1e-9;
  const double roll =
      locked ? std::atan2(r(0, 1) * (pitch > 0.0 ? 1.0 : -1.0), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
  const double yaw = locked ? 0.0 : std::atan2(r(1, 0), r(0, 0));
  return reader ? Outcome(Value::list(Vector3(roll, pitch, yaw))) : reader.failure();
}

// The wrench in the frame at T_from_to relative to the old frame, torques about the new origin.
Outcome wrench_trans(CallContext &, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Transform transform = to_transform(reader.pose(0, "T_from_to"));
  const Vector6 wrench = reader.vector6(1, "w_from");
  const Vector3 force = wrench.head<3>();
  const Vector3 torque = wrench.tail<3>() - transform.translation().cross(force);
  const Eigen::Matrix3d back = transform.linear().transpose();
  return reader ? Outcome(Value::list(joined(back * force, back * torque))) : reader.failure();
}

}  // namespace

void add_pose_builtins(Library & library)
{
  library.add({"pose_add", {"p_1", "p_2"}, 2, pose_add});
  library.add({"pose_sub", {"p_to", "p_from"}, 2, pose_sub});
  library.add({"pose_trans", {"p_from", "p_from_to"}, 2, pose_trans_builtin});
  library.add({"pose_inv", {"p_from"}, 1, pose_inv_builtin});
  library.add({"pose_dist", {"p_from", "p_to"}, 2, pose_dist});
  library.add({"point_dist", {"p_from", "p_to"}, 2, point_dist});
  library.add({"interpolate_pose", {"p_from", "p_to", "alpha"}, 3, interpolate});
  library.add({"rpy2rotvec", {"rpy_vector"}, 1, rpy2rotvec});
  library.add({"rotvec2rpy", {"rotation_vector"}, 1, rotvec2rpy});
  library.add({"wrench_trans", {"T_from_to", "w_from"}, 2, wrench_trans});
}

}  // namespace ur_simulator::urscript
