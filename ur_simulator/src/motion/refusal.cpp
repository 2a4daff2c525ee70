#include "motion/refusal.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/pose.hpp"
#include "motion/arm.hpp"

namespace ur_simulator {

Refusal not_finite(std::string_view call, std::string_view field, const Vector6 & values)
{
  if (is_finite(values)) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be six finite numbers, is [{}, {}, {}, {}, {}, {}]", call, field, values[0],
                     values[1], values[2], values[3], values[4], values[5]);
}

Refusal not_within(std::string_view call, std::string_view field, double value, double least, double most)
{
  if (value >= least && value <= most) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be in [{}, {}], is {}", call, field, least, most, value);
}

Refusal not_positive(std::string_view call, std::string_view field, double value)
{
  if (std::isfinite(value) && value > 0.0) {
    return std::nullopt;
  }
  return fmt::format("{}: {} must be greater than 0, is {}", call, field, value);
}

Refusal beyond_joint_limits(std::string_view call, const RobotModel & model, const Vector6 & target)
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (target[i] < model.position_min[i] || target[i] > model.position_max[i]) {
      return fmt::format("{}: joint {} of the target is {:.4f} rad, beyond its limits [{:.4f}, {:.4f}]", call,
                         i, target[i], model.position_min[i], model.position_max[i]);
    }
  }
  return std::nullopt;
}

Refusal bad_options(std::string_view call, const MoveOptions & options)
{
  constexpr double most = 1e9;  // any finite duration or radius
  const bool by_time = options.time > 0.0;
  return first_of({not_within(call, "time", options.time, 0.0, most),
                   not_within(call, "blend radius", options.blend_radius, 0.0, most),
                   by_time && std::isfinite(options.acceleration) && options.acceleration >= 0.0
                       ? std::nullopt
                       : not_positive(call, "acceleration", options.acceleration),
                   by_time ? std::nullopt : not_positive(call, "velocity", options.velocity)});
}

Refusal first_of(std::initializer_list<Refusal> refusals)
{
  for (const Refusal & refusal : refusals) {
    if (refusal) {
      return refusal;
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator
