#include "kinematics/link_shapes.hpp"

#include <algorithm>

namespace ur_simulator {
namespace {

// Proportions: shapes.py of ur_ros_rtde_description. test_models.py there compares the cylinders.
constexpr double upper_tube =
    0.74;  // radius of the tube of the upper arm, in radii of the shoulder lift joint
constexpr double forearm_tube = 0.92;  // radius of the tube of the forearm, in radii of the wrist 1 joint

enum class End { joined, free };

/// Collects cylinders. Positions are given in the frame of the joint: z is its axis.
class CylinderList {
 public:
  explicit CylinderList(const RobotModel & model) : model_(model) {}

  void add(Body body, const Vector3 & begin, const Vector3 & end, double radius, End kind = End::joined)
  {
    cylinders_.push_back({body, {to_link(body, begin), to_link(body, end)}, radius, kind == End::free});
  }
  std::vector<LinkCylinder> take() { return std::move(cylinders_); }

 private:
  /// From the frame of the joint to that of the Denavit-Hartenberg row.
  Vector3 to_link(Body body, const Vector3 & position) const
  {
    if (body == Body::base) {
      return position;
    }
    const auto row = static_cast<Eigen::Index>(body) - 1;
    return Eigen::AngleAxisd(-model_.alpha[row], Vector3::UnitX()) *
           Vector3(position - model_.a[row] * Vector3::UnitX());
  }

  const RobotModel & model_;
  std::vector<LinkCylinder> cylinders_;
};

void add_base_and_shoulder(const RobotModel & model, CylinderList & list)
{
  const double shoulder = model.joint_radius[0];
  const double lift = model.joint_radius[1];
  const double base_top = model.d[0] - 1.1 * shoulder;  // boundary between base and shoulder
  list.add(Body::base, {0, 0, base_top}, {0, 0, 0}, shoulder, End::free);
  list.add(Body::shoulder, {0, 0, base_top - model.d[0]}, {0, 0, 0}, shoulder);
  list.add(Body::shoulder, {0, 0, 0}, {0, -(model.upper_arm_offset - 1.05 * lift), 0}, lift);
}

void add_upper_arm_and_forearm(const RobotModel & model, CylinderList & list)
{
  const double upper = model.upper_arm_offset;
  const double fore = model.forearm_offset;
  const double a2 = model.a[1];
  const double a3 = model.a[2];
  const double lift = model.joint_radius[1];
  const double elbow = model.joint_radius[2];
  const double wrist_1 = model.joint_radius[3];
  const double elbow_side = (upper + fore) / 2.0;
  const double wrist_side = (fore + model.d[3]) / 2.0;
  list.add(Body::upper_arm, {0, 0, upper - 1.05 * lift}, {0, 0, upper + lift}, lift, End::free);
  list.add(Body::upper_arm, {a2, 0, upper}, {0, 0, upper}, upper_tube * lift);
  list.add(Body::upper_arm, {a2, 0, elbow_side}, {a2, 0, upper + elbow}, elbow, End::free);
  list.add(Body::forearm, {0, 0, elbow_side}, {0, 0, fore - elbow}, elbow, End::free);
  list.add(Body::forearm, {a3, 0, fore}, {0, 0, fore}, forearm_tube * wrist_1);
  list.add(Body::forearm, {a3, 0, wrist_side}, {a3, 0, fore - wrist_1}, wrist_1, End::free);
}

void add_wrist(const RobotModel & model, CylinderList & list)
{
  const double wrist_1 = model.joint_radius[3];
  const double wrist_2 = model.joint_radius[4];
  const double wrist_3 = model.joint_radius[5];
  const double d4 = model.d[3];
  const double d5 = model.d[4];
  const double d6 = model.d[5];
  const double wrist_side = (model.forearm_offset + d4) / 2.0;
  const double flange_length = 0.42 * d6;
  list.add(Body::wrist_1, {0, 0, wrist_side - d4}, {0, 0, wrist_1}, wrist_1, End::free);
  list.add(Body::wrist_1, {0, 0, 0}, {0, -d5 / 2.0, 0}, wrist_1);
  list.add(Body::wrist_2, {0, 0, -d5 / 2.0}, {0, 0, wrist_2}, wrist_2, End::free);
  // Free: a hemisphere there would reach almost to the flange, which may be pressed into soft objects.
  list.add(Body::wrist_2, {0, 0, 0}, {0, d6 - flange_length, 0}, wrist_2, End::free);
  list.add(Body::wrist_3, {0, 0, -flange_length}, {0, 0, 0}, wrist_3, End::free);
}

}  // namespace

std::string_view to_string(Body body)
{
  constexpr std::array<std::string_view, body_count> names{"base",    "shoulder", "upper arm", "forearm",
                                                           "wrist 1", "wrist 2",  "wrist 3"};
  return names[static_cast<std::size_t>(body)];
}

std::vector<LinkCylinder> link_cylinders(const RobotModel & model)
{
  CylinderList list(model);
  add_base_and_shoulder(model, list);
  add_upper_arm_and_forearm(model, list);
  add_wrist(model, list);
  return list.take();
}

std::vector<Capsule> link_capsules(const RobotModel & model)
{
  std::vector<Capsule> capsules;
  for (const LinkCylinder & cylinder : link_cylinders(model)) {
    Segment axis = cylinder.axis;
    if (cylinder.free_end) {
      const Vector3 length = axis.end - axis.begin;
      axis.end = axis.begin + std::max(0.0, 1.0 - cylinder.radius / length.norm()) * length;
    }
    capsules.push_back({cylinder.body, axis, cylinder.radius});
  }
  return capsules;
}

Capsule in_base_frame(const Capsule & capsule, const std::array<Transform, 6> & frames)
{
  if (capsule.body == Body::base) {
    return capsule;
  }
  const Transform & frame = frames[static_cast<std::size_t>(capsule.body) - 1];
  return {capsule.body, {frame * capsule.axis.begin, frame * capsule.axis.end}, capsule.radius};
}

}  // namespace ur_simulator
