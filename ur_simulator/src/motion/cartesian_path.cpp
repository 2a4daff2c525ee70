#include "motion/cartesian_path.hpp"

#include <cmath>

#include "common/pose.hpp"
#include "kinematics/forward.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator {
namespace {

constexpr double near_singularity =
    0.1;  // dexterity under which an excess of speed is put down to a singularity

}  // namespace

CartesianPath::CartesianPath(const RobotModel & model, const Vector6 & tcp_offset)
    : model_(&model), offset_(to_transform(tcp_offset)), offset_inverse_(offset_.inverse())
{
}

Transform CartesianPath::tcp(const Vector6 & joints) const
{
  return forward_flange(*model_, joints) * offset_;
}

Vector6 CartesianPath::twist(const Setpoint & now) const
{
  const auto frames = link_frames(*model_, now.position);
  return jacobian(frames, frames[5] * offset_.translation()) * now.velocity;
}

std::optional<Vector6> CartesianPath::joints(const Transform & pose, const Vector6 & seed) const
{
  const auto found = inverse_nearest(*model_, pose * offset_inverse_, seed);
  return found ? std::optional<Vector6>(*found) : std::nullopt;
}

bool CartesianPath::same_tool(const CartesianPath & other) const
{
  return offset_.matrix() == other.offset_.matrix();
}

std::optional<MotionFault> CartesianPath::follow(const Transform & pose, double duration,
                                                 Setpoint & now) const
{
  const auto next = joints(pose, now.position);
  if (!next) {
    return out_of_reach(now.position);
  }
  const Vector6 velocity = (*next - now.position) / duration;
  Eigen::Index worst = 0;
  const double excess = velocity.cwiseAbs().cwiseQuotient(model_->velocity_max).maxCoeff(&worst);
  const double jump = (velocity - now.velocity).cwiseAbs().maxCoeff();
  if (excess > 1.0 + 1e-6 || jump > 2.0 * model_->acceleration_max[worst] * duration) {
    const bool singular = dexterity(*model_, now.position) < near_singularity;
    return MotionFault{singular ? MotionFault::Kind::singularity : MotionFault::Kind::joint_speed_limit,
                       static_cast<int>(worst), std::abs(velocity[worst]), model_->velocity_max[worst]};
  }
  now = {*next, velocity};
  return std::nullopt;
}

MotionFault CartesianPath::out_of_reach(const Vector6 & joints) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double above = model_->position_max[i] - joints[i];
    const double below = joints[i] - model_->position_min[i];
    if (above < 0.02 || below < 0.02) {
      return {MotionFault::Kind::joint_position_limit, static_cast<int>(i), joints[i],
              above < below ? model_->position_max[i] : model_->position_min[i]};
    }
  }
  return {MotionFault::Kind::unreachable};
}

}  // namespace ur_simulator
