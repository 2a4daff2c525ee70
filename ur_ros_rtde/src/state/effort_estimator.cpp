#include "state/effort_estimator.hpp"

#include <cmath>

namespace ur_ros_rtde {
namespace {
constexpr double forgetting_factor = 0.998;  // per sample: a time constant of 1 s at 500 Hz
constexpr double min_current = 0.05;         // A: smaller currents are mostly noise
}  // namespace

Vector6 EffortEstimator::update(const Sample & sample)
{
  if (std::isfinite(sample.actual_current_as_torque[0])) {
    return sample.actual_current_as_torque;
  }
  Vector6 efforts{};
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    Ratio & ratio = ratios_[i];
    const double current = sample.target_current[i];
    const double moment = sample.target_moment[i];
    if (std::isfinite(current) && std::isfinite(moment) && std::abs(current) > min_current) {
      ratio.moment_current = forgetting_factor * ratio.moment_current + moment * current;
      ratio.current_current = forgetting_factor * ratio.current_current + current * current;
    }
    const bool known = ratio.current_current > 0.0;
    efforts[i] = known ? ratio.moment_current / ratio.current_current * sample.actual_current[i] : moment;
  }
  return efforts;
}

}  // namespace ur_ros_rtde
