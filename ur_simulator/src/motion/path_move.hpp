#pragma once

#include <variant>

#include "kinematics/robot_model.hpp"
#include "motion/cartesian_path.hpp"
#include "motion/joint_leg.hpp"
#include "motion/motion.hpp"
#include "motion/path_clock.hpp"
#include "motion/speed_profile.hpp"
#include "motion/takeover.hpp"
#include "motion/tcp_leg.hpp"

namespace ur_simulator {

/// A way and how it is covered.
struct PathLeg {
  std::variant<JointLeg, TcpLeg> way;
  SpeedProfile profile;
  double blend_radius = 0.0;  ///< m, about its target
  bool process = false;       ///< movep: into another one it goes by an arc
};

/// Every motion along a path to a target: movej, movel, movep, movec, servoc.
/// It takes over a motion before it in one of two ways. What is no path, or not yet in its blend, runs out
/// while the new path, which begins at rest, is laid over it. A path in its blend goes on to its own target,
/// and the new one, which begins at rest there, is laid over that: as the one decelerates evenly and the
/// other accelerates evenly, the sum is a parabola, in joint space between two joint motions, else of the
/// TCP.
class PathMove final : public Motion {
 public:
  PathMove(const RobotModel & model, const CartesianPath & path, const PathLeg & leg,
           const Runout & runout = {});
  /// Blended with `before`, which is in its blend; both have their legs meet.
  PathMove(const PathMove & before, const PathLeg & leg);

  std::optional<MotionFault> advance(const Tick & tick, Setpoint & now) override;
  bool released() const override;
  bool done() const override { return done_; }
  void brake() override;

  /// May the next path be blended in?
  bool in_blend() const;
  const PathLeg & leg() const { return leg_; }
  const CartesianPath & path() const { return path_; }
  /// Time since this path began, s of the path.
  double time() const { return clock_.time(); }
  /// The TCP where this path begins, and where it leads to.
  const Transform & start() const { return start_tcp_; }
  Transform target() const;

 private:
  std::optional<MotionFault> advance_joints(const Tick & tick, Setpoint & now);
  std::optional<MotionFault> advance_tcp(const Tick & tick, Setpoint & now);
  Transform tcp_at(const PathLeg & leg, double distance) const;
  double time_before() const { return before_offset_ + clock_.time(); }
  bool before_over() const;
  std::optional<MotionFault> leap(const Setpoint & now, const Vector6 & next, double duration) const;

  const RobotModel * model_;
  CartesianPath path_;
  PathLeg leg_;
  Transform start_tcp_;  ///< of the leg
  // What it takes over: a velocity that runs out, …
  Runout runout_;
  // … or a path in its blend.
  bool blends_ = false;
  PathLeg before_;
  double before_offset_ = 0.0;
  PathClock clock_;
  bool advanced_ = false;  ///< for a cycle at least
  bool done_ = false;
};

}  // namespace ur_simulator
