#include "motion/argument_checks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/pose.hpp"
#include "motion/arm.hpp"

namespace ur_simulator {

Rejection check_finite(std::string_view function, std::string_view argument, const Vector6 & values)
{
  if (is_finite(values)) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be six finite numbers, is [{}, {}, {}, {}, {}, {}]", function, argument,
                     values[0], values[1], values[2], values[3], values[4], values[5]);
}

Rejection check_in_range(std::string_view function, std::string_view argument, double value, double min,
                         double max)
{
  if (value >= min && value <= max) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be in [{}, {}], is {}", function, argument, min, max, value);
}

Rejection check_positive(std::string_view function, std::string_view argument, double value)
{
  if (std::isfinite(value) && value > 0.0) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be greater than 0, is {}", function, argument, value);
}

Rejection check_joint_limits(std::string_view function, const RobotModel & model, const Vector6 & target)
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (target[i] < model.position_min[i] || target[i] > model.position_max[i]) {
      return fmt::format("{}: joint {} of the target is {:.4f} rad, beyond its limits [{:.4f}, {:.4f}]",
                         function, i, target[i], model.position_min[i], model.position_max[i]);
    }
  }
  return std::nullopt;
}

Rejection check_move_options(std::string_view function, const MoveOptions & options)
{
  constexpr double max = 1e9;  // any finite duration or radius
  const bool has_time = options.time > 0.0;
  return first_rejection({check_in_range(function, "time", options.time, 0.0, max),
                          check_in_range(function, "blend radius", options.blend_radius, 0.0, max),
                          has_time && std::isfinite(options.acceleration) && options.acceleration >= 0.0
                              ? std::nullopt
                              : check_positive(function, "acceleration", options.acceleration),
                          has_time ? std::nullopt : check_positive(function, "velocity", options.velocity)});
}

Rejection first_rejection(std::initializer_list<Rejection> rejections)
{
  for (const Rejection & rejection : rejections) {
    if (rejection) {
      return rejection;
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator
