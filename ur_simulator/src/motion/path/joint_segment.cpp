#include "motion/path/joint_segment.hpp"

namespace ur_simulator {

JointSegment::JointSegment(const Vector6 & start, const Vector6 & target) : start_(start), target_(target)
{
  const Vector6 displacement = target - start;
  const double longest = displacement.cwiseAbs().maxCoeff();
  if (longest < 1e-12) {
    return;
  }
  length_ = longest;
  direction_ = displacement / longest;
}

}  // namespace ur_simulator
