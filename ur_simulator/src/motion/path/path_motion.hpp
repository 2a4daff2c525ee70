#pragma once

#include <variant>

#include "kinematics/robot_model.hpp"
#include "motion/motion.hpp"
#include "motion/path/joint_segment.hpp"
#include "motion/path/path_clock.hpp"
#include "motion/path/rate_limit.hpp"
#include "motion/path/residual_motion.hpp"
#include "motion/path/speed_profile.hpp"
#include "motion/path/tcp_segment.hpp"
#include "motion/tcp_kinematics.hpp"

namespace ur_simulator {

/// A path to a target with its speed profile.
struct PathSegment {
  std::variant<JointSegment, TcpSegment> geometry;
  SpeedProfile profile;
  double blend_radius = 0.0;  ///< m, about the target
  bool process = false;       ///< movep: blended with the next movep by a circular arc
};

/// A motion along a path to a target: movej, movel, movep, movec, servoc.
///
/// It takes over from the previous motion in one of two ways:
///  - A motion that is no path, or that is not in its blend yet: its velocity decays while the new path,
///  which begins
///    at rest, is superposed.
///  - A path in its blend continues to its own target; the new path, which begins at rest at that target, is
///    superposed. While the first decelerates and the second accelerates at constant rates, the sum is a
///    parabola: in joint space between two joint motions, of the TCP otherwise.
class PathMotion final : public Motion {
 public:
  PathMotion(const RobotModel & model, const TcpKinematics & kinematics, const PathSegment & segment,
             const ResidualMotion & residual = {});
  /// Blends with `previous`, which is in its blend and ends where `segment` begins.
  PathMotion(const PathMotion & previous, const PathSegment & segment);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;
  bool call_complete() const override;
  bool finished() const override { return finished_; }
  void decelerate() override;

  /// True if the next path may be blended in.
  bool in_blend() const;
  /// True if the path is slowed down because a joint would be too fast.
  bool limited_by_joint_speed() const { return !finished_ && rate_limit_.at(clock_.time()) < 1.0; }
  const PathSegment & segment() const { return segment_; }
  const TcpKinematics & kinematics() const { return kinematics_; }
  /// Time since the path began, s of the path.
  double time() const { return clock_.time(); }
  /// TCP pose at the start and at the target of the path.
  const Transform & start() const { return start_tcp_; }
  Transform target() const;

 private:
  void find_rate_limit(const Vector6 & near_start);
  std::optional<MotionFault> advance_joints(const TimeStep & time_step, Setpoint & setpoint);
  std::optional<MotionFault> advance_tcp(const TimeStep & time_step, Setpoint & setpoint);
  double previous_time() const { return previous_start_time_ + clock_.time(); }
  bool previous_finished() const;
  std::optional<MotionFault> check_jump(const Setpoint & setpoint, const Vector6 & next,
                                        double duration) const;

  const RobotModel * model_;
  TcpKinematics kinematics_;
  PathSegment segment_;
  Transform start_tcp_;
  ResidualMotion residual_;  ///< decaying velocity of the previous motion
  bool blends_ = false;      ///< with previous_
  PathSegment previous_;
  double previous_start_time_ = 0.0;  ///< time of previous_ when this path began
  PathClock clock_;
  RateLimit rate_limit_;
  bool advanced_ = false;  ///< by one cycle at least
  bool finished_ = false;
};

/// TCP pose at a distance along a segment.
Transform tcp_pose_at(const TcpKinematics & kinematics, const PathSegment & segment, double distance);

}  // namespace ur_simulator
