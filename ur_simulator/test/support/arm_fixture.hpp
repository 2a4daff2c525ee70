#pragma once

#include <algorithm>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "motion/arm.hpp"
#include "support/cyclic_fixture.hpp"

namespace ur_simulator::testing {

/// An arm in robot mode RUNNING.
struct ArmFixture : CyclicFixture {
  explicit ArmFixture(const char * name = "ur10e")
      : CyclicFixture(name), arm(model, dt, default_position(model))
  {
    state.robot_mode = RobotMode::running;
    arm.teleport(default_position(model), state);
  }

  void step() override
  {
    begin_cycle();
    previous = state.target;
    arm.step(state);
    max_velocity = max_velocity.cwiseMax(state.target.velocity.cwiseAbs());
    const Vector6 change = (state.target.velocity - previous.velocity) / dt;
    max_acceleration = std::max(max_acceleration, change.cwiseAbs().maxCoeff());
  }
  /// Steps until the call of the motion may return.
  double until_finished(MotionId motion, double limit = 60.0)
  {
    return until([&] { return arm.call_complete(motion); }, limit);
  }
  double until_rest(double limit = 60.0)
  {
    return until([&] { return arm.at_rest(); }, limit);
  }
  Vector6 tcp() const { return state.target_tcp_pose; }
  void reset_maxima()
  {
    max_velocity.setZero();
    max_acceleration = 0.0;
  }

  Arm arm;
  JointState previous;                     ///< target of the previous cycle
  Vector6 max_velocity = Vector6::Zero();  ///< highest target speed of each joint, rad/s
  double max_acceleration = 0.0;           ///< highest target acceleration of any joint, rad/s^2
};

/// The default position, moved away by these angles.
inline Vector6 near_home(const ArmFixture & fixture, const Vector6 & away)
{
  return default_position(fixture.model) + away;
}

/// The larger of the distance (m) and the angle (rad) between two poses.
inline double pose_distance(const Vector6 & a, const Vector6 & b)
{
  const double angle =
      to_rotation_vector(to_rotation_matrix(a.tail<3>()).transpose() * to_rotation_matrix(b.tail<3>()))
          .norm();
  return std::max((a - b).head<3>().norm(), angle);
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
