#pragma once

#include <cstdint>
#include <vector>

#include "path/path.hpp"

namespace ur_ros_rtde::trajectory {

/// Grid of stations along a segment of a path, between two stops. Boundaries of pieces are stations.
struct Grid {
  std::vector<std::uint32_t> piece;      ///< of each interval
  std::vector<double> begin, end;        ///< of each interval, relative to the start of its piece
  std::vector<Joints> d1, d2;            ///< q' and q'' at each station
  std::vector<Joints> d3_begin, d3_end;  ///< q''' at both ends of each interval
  std::vector<double> max_speed;         ///< maximum speed of the path at each station

  std::size_t intervals() const { return piece.size(); }
  std::size_t stations() const { return d1.size(); }
  double width(std::size_t i) const { return end[i] - begin[i]; }

  void reserve(std::size_t count);
  /// Adds the interval from `from` to `to` on a piece. The first call also adds the station at `from`.
  void add(const Path & path, std::size_t piece_index, double from, double to);
};

/// Speed and acceleration along the path at the stations of a grid, and the duration of each interval.
struct Profile {
  std::vector<double> v;  ///< ds/dt at each station
  std::vector<double>
      alpha;  ///< d2s/dt2 at each station; of the TOPP2 solver: in the interval that begins there
  std::vector<double> time;  ///< s, of each interval
};

/// Grid with `count` equal intervals in each piece of [first, last).
Grid uniform_grid(const Path & path, std::size_t first, std::size_t last, std::size_t count);

/// Grid with stations at approximately equal intervals of time `step`. The acceleration of `profile` is
/// constant in each interval of `coarse`. A blend has at least `min_blend_intervals` intervals.
Grid time_spaced_grid(const Path & path, const Grid & coarse, const Profile & profile, double step,
                      std::size_t min_blend_intervals);

}  // namespace ur_ros_rtde::trajectory
