#include "motion/arrival_detector.hpp"

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/motion/motion.hpp"

namespace ur_ros_rtde {
namespace {

bool holds_target(const Sample & sample)
{
  return sample.is_program_running() && std::all_of(sample.target_qd.begin(), sample.target_qd.end(),
                                                    [](double velocity) { return velocity == 0.0; });
}

/// False if a value is NaN.
bool at_target(const Sample & sample)
{
  for (std::size_t i = 0; i < sample.actual_q.size(); ++i) {
    if (!(std::abs(sample.actual_qd[i]) < StandstillDetector::velocity &&
          std::abs(sample.target_q[i] - sample.actual_q[i]) < ArrivalDetector::position)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void ArrivalDetector::add(const Sample & sample, bool operation_ended)
{
  const bool there = at_target(sample);
  const bool left = arrived_ && !there;
  operation_over_ = holds_target(sample) && !left && (operation_over_ || operation_ended);
  arrived_ = operation_over_ && there;
}

}  // namespace ur_ros_rtde
