#pragma once

#include <optional>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator {

/// The wrench of a load at standstill, in the flange frame.
struct LoadMeasurement {
  Vector3 upward;  ///< opposite to the pull of gravity, m/s^2
  Vector6 wrench;
};

struct LoadEstimate {
  double mass = 0.0;                 ///< kg
  Vector3 moment = Vector3::Zero();  ///< mass times center of gravity, kg m
};

/// The load that explains the wrenches best, apart from a constant offset of the sensor. Nothing if the
/// directions of gravity do not determine the load.
std::optional<LoadEstimate> estimate_load(const std::vector<LoadMeasurement> & measurements);

}  // namespace ur_simulator
