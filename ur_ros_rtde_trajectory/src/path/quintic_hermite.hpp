#pragma once

#include <array>

namespace ur_ros_rtde::trajectory {

/// Coefficients of the quintic Hermite polynomial in x, 0 <= x <= 1, from `start` to `start + rise`. `v0`,
/// `v1`, `a0` and `a1` are its first and second derivatives with respect to x at both ends.
template <class T>
std::array<T, 6> quintic_hermite(const T & start, const T & rise, const T & v0, const T & v1, const T & a0,
                                 const T & a1)
{
  return {start,
          v0,
          T(0.5 * a0),
          T(10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1),
          T(-15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1),
          T(6.0 * rise - 3.0 * (v0 + v1) - 0.5 * (a0 - a1))};
}

}  // namespace ur_ros_rtde::trajectory
