#include "solver/speed_spline.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

// Distances covered in an interval, weighted by a line over its time that falls from 1 to 0 (falling) or
// rises from 0 to 1 (rising): integrals of cubic Hermite speeds.
double falling(const Profile & p, std::size_t i)
{
  const double t = p.time[i];
  return t * (0.35 * p.v[i] + 0.15 * p.v[i + 1] + t * (p.alpha[i] / 20.0 - p.alpha[i + 1] / 30.0));
}

double rising(const Profile & p, std::size_t i)
{
  const double t = p.time[i];
  return t * (0.15 * p.v[i] + 0.35 * p.v[i + 1] + t * (p.alpha[i] / 30.0 - p.alpha[i + 1] / 20.0));
}

}  // namespace

double interval_duration(double width, double v0, double alpha0, double v1, double alpha1)
{
  // width = (v0 + v1) / 2 T - (alpha1 - alpha0) / 12 T^2
  const double mean = 0.5 * (v0 + v1);
  const double curvature = (alpha1 - alpha0) / 12.0;
  const double root = mean * mean - 4.0 * curvature * width;
  return 2.0 * width / std::max(mean + std::sqrt(std::max(root, 0.0)), 1e-12);
}

SpeedSpline::SpeedSpline(const Grid & grid, const Profile & profile)
    : duration_(profile.time), speed_(profile.v), weights_(profile.v.size())
{
  for (std::size_t m = 1; m < grid.intervals(); ++m) {
    // Halves of the hat function at m. The clamps keep them inside their intervals if the profile is
    // inaccurate.
    const double left =
        std::clamp(rising(profile, m - 1), 0.05 * grid.width(m - 1), 0.95 * grid.width(m - 1));
    const double right = std::clamp(falling(profile, m), 0.05 * grid.width(m), 0.95 * grid.width(m));
    weights_[m] = {left / (left + right), 0.5 / (left + right)};
  }
}

Profile SpeedSpline::profile(const Grid & grid, const std::vector<double> & w) const
{
  const std::size_t count = intervals();
  Profile result;
  result.v.resize(count + 1);
  result.alpha.resize(count + 1);
  result.time.resize(count);
  for (std::size_t m = 0; m <= count; ++m) {
    result.v[m] = std::sqrt(std::max(a(w, m), 0.0));
    result.alpha[m] = b(w, m);
  }
  for (std::size_t i = 0; i < count; ++i) {
    result.time[i] =
        interval_duration(grid.width(i), result.v[i], result.alpha[i], result.v[i + 1], result.alpha[i + 1]);
  }
  return result;
}

}  // namespace ur_ros_rtde::trajectory
