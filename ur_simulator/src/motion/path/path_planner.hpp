#pragma once

#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "motion/path/path_motion.hpp"

namespace ur_simulator {

/// Plans the paths of movej, movel, movep, movec and servoc from the current setpoint. Targets and options
/// must have been checked.
class PathPlanner {
 public:
  /// `previous`: a path in its blend, with which the new path is blended; null if there is none, then the
  /// velocity of the setpoint decays. The planner keeps references to its arguments.
  PathPlanner(const RobotModel & model, const TcpKinematics & kinematics, const Setpoint & setpoint,
              double cycle_time, const PathMotion * previous);

  bool blends() const { return previous_ != nullptr; }
  /// Start of the next path: the target of the previous path, or the current TCP pose.
  Transform start() const;
  /// True if a path to this TCP pose with this blend radius (m) would begin or end inside the previous blend.
  bool overlaps(const Transform & target, double blend_radius) const;

  PathMotion plan_joint(const Vector6 & target, const MoveOptions & options) const;
  PathMotion plan_line(const Transform & target, const MoveOptions & options) const;
  PathMotion plan_process(const Transform & target, const MoveOptions & options) const;
  /// Nothing if the three points are collinear.
  std::optional<PathMotion> plan_circle(const Vector3 & via, const Transform & target, CircleMode mode,
                                        const MoveOptions & options) const;
  PathMotion plan_servo_circle(const Transform & target, const MoveOptions & options) const;
  /// Acceleration and velocity in the options are fractions of the highest values that the path allows.
  PathMotion plan_optimal_joint(const Vector6 & target, MoveOptions options) const;
  PathMotion plan_optimal_line(const Transform & target, MoveOptions options) const;

 private:
  /// Where a path begins, and the velocity that decays until the arm is on the path.
  struct PathStart {
    Vector6 joints;
    Transform tcp;
    ResidualMotion residual;
  };
  PathStart joint_path_start(double acceleration) const;
  PathStart tcp_path_start(const Vector6 & twist, double acceleration) const;

  /// Highest speed and acceleration along a segment at which every joint keeps its limits.
  struct PathLimits {
    double speed;
    double acceleration;
  };
  PathLimits path_limits(const TcpSegment & segment, double joint_acceleration) const;

  PathMotion make_joint_path(const PathStart & path_start, const JointSegment & segment,
                             const MoveOptions & options) const;
  PathMotion make_tcp_path(const PathStart & path_start, const TcpSegment & segment,
                           const MoveOptions & options, bool process) const;
  PathMotion make_path(PathSegment segment, const SpeedProfile & profile,
                       const ResidualMotion & residual) const;
  /// Sets the fields of the constraints that blending requires.
  void set_blend_timing(const PathSegment & segment, ProfileConstraints & constraints) const;
  std::optional<PathMotion> plan_corner(const TcpSegment & outgoing, const MoveOptions & options) const;
  std::optional<PathMotion> plan_tangent_arc(const Transform & target, const MoveOptions & options) const;
  double joint_acceleration_limit(double blend_radius) const;
  /// The length, from the start or the end of a segment on, that lies inside a ball about that point; in the
  /// segment's unit of distance.
  double length_within_radius(const PathSegment & segment, double length, double radius, bool at_end) const;

  const RobotModel & model_;
  const TcpKinematics & kinematics_;
  const Setpoint & setpoint_;
  double cycle_time_;
  const PathMotion * previous_;
  Vector6 previous_target_joints_ = Vector6::Zero();
  double distance_to_waypoint_ = 0.0;  ///< m, from the current TCP to the target of the previous path
};

}  // namespace ur_simulator
