#include "motion/joint_leg.hpp"

namespace ur_simulator {

JointLeg::JointLeg(const Vector6 & start, const Vector6 & target) : start_(start), target_(target)
{
  const Vector6 way = target - start;
  const double longest = way.cwiseAbs().maxCoeff();
  if (longest < 1e-12) {
    return;
  }
  length_ = longest;
  direction_ = way / longest;
}

}  // namespace ur_simulator
