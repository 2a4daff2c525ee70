#include "motion/tcp_kinematics.hpp"

#include <cmath>

#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "kinematics/inverse_kinematics.hpp"

namespace ur_simulator {
namespace {

// singularity_distance() below which an excess of joint speed is attributed to a singularity.
constexpr double near_singularity = 0.1;

}  // namespace

TcpKinematics::TcpKinematics(const RobotModel & model, const Vector6 & tcp_offset)
    : model_(&model), offset_(to_transform(tcp_offset)), offset_inverse_(offset_.inverse())
{
}

Transform TcpKinematics::tcp_pose(const Vector6 & joints) const
{
  return flange_pose(*model_, joints) * offset_;
}

Vector6 TcpKinematics::tcp_twist(const Setpoint & setpoint) const
{
  const auto frames = link_frames(*model_, setpoint.position);
  return jacobian(frames, frames[5] * offset_.translation()) * setpoint.velocity;
}

std::optional<Vector6> TcpKinematics::inverse(const Transform & pose, const Vector6 & seed) const
{
  const auto found = nearest_inverse_solution(*model_, pose * offset_inverse_, seed);
  return found ? std::optional<Vector6>(*found) : std::nullopt;
}

bool TcpKinematics::has_same_tool(const TcpKinematics & other) const
{
  return offset_.matrix() == other.offset_.matrix();
}

std::optional<MotionFault> TcpKinematics::move_to(const Transform & pose, double duration,
                                                  Setpoint & setpoint) const
{
  const auto next = inverse(pose, setpoint.position);
  if (!next) {
    return unreachable_fault(setpoint.position);
  }
  const Vector6 velocity = (*next - setpoint.position) / duration;
  Eigen::Index fastest = 0, jumping = 0;
  const double speed_ratio = velocity.cwiseAbs().cwiseQuotient(model_->velocity_max).maxCoeff(&fastest);
  const double jump = (velocity - setpoint.velocity).cwiseAbs().maxCoeff(&jumping);
  const bool too_fast = speed_ratio > 1.0 + 1e-6;
  const double max_acceleration = 2.0 * model_->acceleration_max[jumping];
  if (too_fast || jump > max_acceleration * duration) {
    const bool singular = singularity_distance(*model_, setpoint.position) < near_singularity;
    const auto kind = singular ? MotionFault::Kind::singularity : MotionFault::Kind::joint_speed_limit;
    return too_fast ? MotionFault{kind, static_cast<int>(fastest), std::abs(velocity[fastest]),
                                  model_->velocity_max[fastest]}
                    : MotionFault{kind, static_cast<int>(jumping), jump / duration, max_acceleration,
                                  MotionFault::Quantity::acceleration};
  }
  setpoint = {*next, velocity};
  return std::nullopt;
}

MotionFault TcpKinematics::unreachable_fault(const Vector6 & joints) const
{
  constexpr double near_limit = 0.02;  // rad
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double to_max = model_->position_max[i] - joints[i];
    const double to_min = joints[i] - model_->position_min[i];
    if (to_max < near_limit || to_min < near_limit) {
      return {MotionFault::Kind::joint_position_limit, static_cast<int>(i), joints[i],
              to_max < to_min ? model_->position_max[i] : model_->position_min[i]};
    }
  }
  return {MotionFault::Kind::unreachable};
}

}  // namespace ur_simulator
