#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "motion/arm.hpp"
#include "random_joints.hpp"

namespace ur_simulator::testing {

/// An arm with power on, and the clock that drives it.
struct ArmRig {
  explicit ArmRig(const char * name = "ur10e")
      : model(model_named(name)), dt(model.cycle_time()), arm(model, dt, default_position(model))
  {
    state.robot_mode = RobotMode::running;
    arm.teleport(default_position(model), state);
  }

  void step()
  {
    ++state.cycle;
    state.timestamp = static_cast<double>(state.cycle) * dt;
    before = state.target;
    arm.step(state);
    fastest = fastest.cwiseMax(state.target.velocity.cwiseAbs());
    const Vector6 change = (state.target.velocity - before.velocity) / dt;
    hardest = std::max(hardest, change.cwiseAbs().maxCoeff());
  }
  void run(double seconds)
  {
    for (double t = 0.0; t < seconds - 0.5 * dt; t += dt) {
      step();
    }
  }
  /// Cycles until the call may return; fails the test after `limit` s of simulated time.
  double until_finished(MotionId motion, double limit = 60.0)
  {
    return until([&] { return arm.finished(motion); }, limit);
  }
  double until_rest(double limit = 60.0)
  {
    return until([&] { return arm.at_rest(); }, limit);
  }
  double until(const std::function<bool()> & reached, double limit)
  {
    double t = 0.0;
    bool is_reached = reached();
    while (!is_reached && t < limit) {
      step();
      t += dt;
      is_reached = reached();
    }
    EXPECT_TRUE(is_reached) << "not within " << limit << " s of simulated time";
    return t;
  }
  Vector6 tcp() const { return state.target_tcp_pose; }
  void forget_extremes()
  {
    fastest.setZero();
    hardest = 0.0;
  }

  const RobotModel & model;
  double dt;
  ControllerState state;
  Arm arm;
  JointState before;                  ///< target of the cycle before
  Vector6 fastest = Vector6::Zero();  ///< highest target speed of each joint, rad/s
  double hardest = 0.0;               ///< highest change of any joint's target velocity, rad/s^2
};

/// Of two poses: m and rad, whichever is more (a half turn has two rotation vectors).
inline double pose_distance(const Vector6 & a, const Vector6 & b)
{
  const double turn =
      to_rotation_vector(to_rotation(a.tail<3>()).transpose() * to_rotation(b.tail<3>())).norm();
  return std::max((a - b).head<3>().norm(), turn);
}

inline Vector6 six(double a, double b, double c, double d, double e, double f)
{
  Vector6 result;
  result << a, b, c, d, e, f;
  return result;
}

inline Vector6 six(double all)
{
  return Vector6::Constant(all);
}

}  // namespace ur_simulator::testing
