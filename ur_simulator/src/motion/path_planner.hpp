#pragma once

#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "motion/path_move.hpp"

namespace ur_simulator {

/// Lays the paths of movej, movel, movep, movec and servoc from where the arm is and how it moves. Targets
/// and options are taken as checked.
class PathPlanner {
 public:
  /// `before`: a path in its blend, which the new one is blended with; else null, and what moves runs out.
  /// The planner must not outlive it.
  PathPlanner(const RobotModel & model, const CartesianPath & path, const Setpoint & now, double cycle_time,
              const PathMove * before);

  /// Where the next path begins: the target of the motion it is blended with, or where the arm comes to rest.
  Transform start() const;
  /// Would a path to this TCP with this blend radius (m) begin or end within the blend before it?
  bool overlaps(const Transform & target, double blend_radius) const;

  PathMove joint(const Vector6 & target, const MoveOptions & options) const;
  PathMove line(const Transform & target, const MoveOptions & options) const;
  PathMove process(const Transform & target, const MoveOptions & options) const;
  /// Nothing when the three points make no circle.
  std::optional<PathMove> circle(const Vector3 & via, const Transform & target, CircleMode mode,
                                 const MoveOptions & options) const;
  PathMove servo_circle(const Transform & target, const MoveOptions & options) const;
  /// Acceleration and velocity in the options are fractions of the highest that this path allows.
  PathMove optimal_joint(const Vector6 & target, MoveOptions options) const;
  PathMove optimal_line(const Transform & target, MoveOptions options) const;

 private:
  /// Where a path begins, and the velocity that runs out until it is there.
  struct Beginning {
    Vector6 joints;
    Transform tcp;
    Runout runout;
  };
  Beginning begin_joints(double acceleration) const;
  Beginning begin_tcp(const Vector6 & twist, double acceleration) const;

  /// The highest speed and acceleration along a leg at which every joint keeps its limits.
  struct Pace {
    double speed;
    double acceleration;
  };
  Pace highest_pace(const TcpLeg & leg, double joint_acceleration) const;

  PathMove lay_joint(const Beginning & from, const JointLeg & leg, const MoveOptions & options) const;
  PathMove lay_tcp(const Beginning & from, const TcpLeg & leg, const MoveOptions & options,
                   bool process) const;
  PathMove lay(PathLeg leg, const SpeedProfile & profile, const Runout & runout) const;
  /// Fills in what blending asks of the timing.
  void blend(const PathLeg & leg, PathTiming & timing) const;
  std::optional<PathMove> corner(const TcpLeg & out, const MoveOptions & options) const;
  std::optional<PathMove> tangential(const Transform & target, const MoveOptions & options) const;
  double joint_acceleration_limit(double blend_radius) const;
  Transform tcp_at(const PathLeg & leg, double distance) const;
  /// How much of a leg, from its start or its end on, lies within a ball about that; in its unit of distance.
  double within(const PathLeg & leg, double length, double radius, bool at_end) const;

  const RobotModel & model_;
  const CartesianPath & path_;
  const Setpoint & now_;
  double cycle_time_;
  const PathMove * before_;
  Vector6 before_joints_ = Vector6::Zero();  ///< at the target of the path before
  double reached_radius_ = 0.0;              ///< m from there
};

}  // namespace ur_simulator
