#include <random>

#include "kinematics/robot_model.hpp"

namespace ur_simulator {
namespace {

// Standard deviations. Together they displace the flange by about a millimeter, as the calibrations do that
// users of ur_calibration have published.
constexpr double length_deviation = 3e-4;  // m
constexpr double angle_deviation = 5e-4;   // rad

}  // namespace

RobotModel with_random_calibration(RobotModel model, std::uint64_t seed)
{
  std::mt19937_64 engine(seed);
  // Sums of uniform numbers, which are the same with every standard library, unlike std::normal_distribution.
  const auto normal = [&engine](double deviation) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      sum += static_cast<double>(engine() >> 11U) * 0x1p-53;
    }
    return deviation * sum;
  };
  for (Eigen::Index i = 0; i < 6; ++i) {
    model.d[i] += normal(length_deviation);
    model.theta[i] += normal(angle_deviation);
    if (i < 5) {  // the flange has no joint behind it
      model.a[i] += normal(length_deviation);
      model.alpha[i] += normal(angle_deviation);
    }
  }
  model.calibrated = true;
  return model;
}

}  // namespace ur_simulator
