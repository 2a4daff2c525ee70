#include "path/spline.hpp"

#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

struct Tridiagonal {
  std::vector<double> lower, diagonal, upper;
  std::vector<Joints> right;

  explicit Tridiagonal(std::size_t size) : lower(size), diagonal(size), upper(size), right(size) {}

  std::vector<Joints> solve() &&
  {
    const std::size_t size = diagonal.size();
    for (std::size_t i = 1; i < size; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      right[i] -= factor * right[i - 1];
    }
    right[size - 1] /= diagonal[size - 1];
    for (std::size_t i = size - 1; i-- > 0;) {
      right[i] = (right[i] - upper[i] * right[i + 1]) / diagonal[i];
    }
    return std::move(right);
  }
};

// Equations of the inner knots: the second derivatives of both sides are equal.
Tridiagonal inner_rows(std::span<const Joints> values, std::span<const double> widths)
{
  Tridiagonal system(values.size());
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double before = 1.0 / widths[i - 1];
    const double after = 1.0 / widths[i];
    system.lower[i] = before;
    system.diagonal[i] = 2.0 * (before + after);
    system.upper[i] = after;
    system.right[i] = 3.0 * ((values[i] - values[i - 1]) * (before * before) +
                             (values[i + 1] - values[i]) * (after * after));
  }
  return system;
}

// Of one joint between two knots.
void limit_slopes(double & before, double & after, double secant)
{
  constexpr double circle = 3.0;  // of the slopes relative to the secant
  if (before * secant <= 0.0) {
    before = 0.0;
  }
  if (after * secant <= 0.0) {
    after = 0.0;
  }
  const double size = std::hypot(before, after);
  if (size > circle * std::abs(secant)) {
    before *= circle * std::abs(secant) / size;
    after *= circle * std::abs(secant) / size;
  }
}

}  // namespace

std::vector<Joints> natural_spline_slopes(std::span<const Joints> values, std::span<const double> widths)
{
  const std::size_t last = values.size() - 1;
  Tridiagonal system = inner_rows(values, widths);
  system.diagonal[0] = 2.0;
  system.upper[0] = 1.0;
  system.right[0] = 3.0 * (values[1] - values[0]) / widths[0];
  system.lower[last] = 1.0;
  system.diagonal[last] = 2.0;
  system.right[last] = 3.0 * (values[last] - values[last - 1]) / widths[last - 1];
  return std::move(system).solve();
}

std::vector<Joints> clamped_spline_slopes(std::span<const Joints> values, std::span<const double> widths,
                                          const Joints & first, const Joints & last)
{
  Tridiagonal system = inner_rows(values, widths);
  system.diagonal.front() = 1.0;
  system.right.front() = first;
  system.diagonal.back() = 1.0;
  system.right.back() = last;
  return std::move(system).solve();
}

void limit_slopes(std::vector<Joints> & slopes, std::span<const Joints> values,
                  std::span<const double> widths, double dense)
{
  const auto is_dense = [&](std::size_t i) { return i >= widths.size() || widths[i] <= dense; };
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (is_dense(i) && is_dense(i + 1) && (i == 0 || is_dense(i - 1))) {
      continue;
    }
    const Joints secant = (values[i + 1] - values[i]) / widths[i];
    for (int j = 0; j < joint_count; ++j) {
      limit_slopes(slopes[i][j], slopes[i + 1][j], secant[j]);
    }
  }
}

}  // namespace ur_ros_rtde::trajectory
