#include "ur_ros_rtde_trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

// Piece of the path at `time` and the state on it, clamped to the piece against rounding errors.
struct PathLocation {
  const PathPiece * curve = nullptr;
  PathState path_state;
  double s() const { return curve->start + path_state.u; }
};

PathLocation locate(const Motion & motion, double time)
{
  if (motion.timing.empty()) {
    return {&motion.path->pieces.front(), {}};
  }
  const TimingLawPiece & piece = motion.timing[motion.piece_at(time)];
  PathLocation result{&motion.path->pieces[piece.piece],
                      piece.at(std::clamp(time, piece.start, piece.end()))};
  result.path_state.u = std::clamp(result.path_state.u, 0.0, result.curve->length);
  return result;
}

}  // namespace

double Trajectory::duration() const
{
  return motion_->duration();
}

Point Trajectory::sample(double time) const
{
  const PathLocation here = locate(*motion_, time);
  const PathPoint point = here.curve->at(here.path_state.u);
  if (!(time >= 0.0) || time >= duration()) {
    Point rest;
    rest.position = point.q;
    return rest;
  }
  return joint_motion(point, here.path_state);
}

double Trajectory::progress(double time) const
{
  const double length = motion_->path->length();
  return length > 0.0 && duration() > 0.0 ? std::clamp(locate(*motion_, time).s() / length, 0.0, 1.0) : 1.0;
}

std::size_t Trajectory::waypoint_count() const
{
  return motion_->path->waypoints.size();
}

double Trajectory::time_of_waypoint(std::size_t waypoint) const
{
  const double target = motion_->path->waypoints.at(waypoint);
  const auto & timing = motion_->timing;
  const auto begins_at = [&](const TimingLawPiece & piece) {
    return motion_->path->pieces[piece.piece].start + piece.c[0];
  };
  const auto after =
      std::upper_bound(timing.begin(), timing.end(), target,
                       [&](double s, const TimingLawPiece & piece) { return s < begins_at(piece); });
  if (after == timing.begin()) {
    return 0.0;
  }
  const TimingLawPiece & piece = *(after - 1);
  const double start = motion_->path->pieces[piece.piece].start;
  double low = piece.start;
  double high = piece.end();
  for (int round = 0; round < 60 && high - low > 1e-12; ++round) {
    const double middle = 0.5 * (low + high);
    (start + piece.at(middle).u < target ? low : high) = middle;
  }
  return high;
}

std::size_t Trajectory::waypoint_at(double time) const
{
  constexpr double rounding = 1e-9;  // rad
  const auto & waypoints = motion_->path->waypoints;
  const double s = locate(*motion_, time).s() + rounding;
  const auto after = std::upper_bound(waypoints.begin(), waypoints.end(), s);
  return after == waypoints.begin() ? 0 : static_cast<std::size_t>(after - waypoints.begin()) - 1;
}

Trajectory Trajectory::slowed(double fraction) const
{
  if (fraction == 1.0) {
    return *this;
  }
  auto copy = std::make_shared<Motion>(*motion_);
  copy->stretch(1.0 / fraction);
  return Trajectory(std::move(copy));
}

}  // namespace ur_ros_rtde::trajectory
