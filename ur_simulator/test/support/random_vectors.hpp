#pragma once

#include <random>

#include "kinematics/robot_model.hpp"

namespace ur_simulator::testing {

/// Random numbers, uniform in [-range, range]; the same sequence in every run.
class RandomVectors {
 public:
  explicit RandomVectors(std::uint64_t seed) : engine_(seed) {}

  double number(double range) { return std::uniform_real_distribution<double>(-range, range)(engine_); }
  Vector6 six(double range)
  {
    Vector6 result;
    for (Eigen::Index i = 0; i < 6; ++i) {
      result[i] = number(range);
    }
    return result;
  }
  std::size_t below(std::size_t count)
  {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

inline const RobotModel & model_named(const char * name)
{
  return find_robot_model(name).value();
}

}  // namespace ur_simulator::testing
