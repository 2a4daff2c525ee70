#pragma once

#include <cstdint>
#include <vector>

#include "path/path.hpp"

namespace ur_ros_rtde::trajectory {

/// Stations along the part of a path between two stops. Borders of pieces are stations.
struct Grid {
  std::vector<std::uint32_t> piece;      ///< of each interval
  std::vector<double> begin, end;        ///< of each interval, from the beginning of its piece
  std::vector<Joints> d1, d2;            ///< q' and q'' at each station
  std::vector<Joints> d3_begin, d3_end;  ///< q''' at both ends of each interval
  std::vector<double> max_speed;         ///< of the path itself at each station

  std::size_t intervals() const { return piece.size(); }
  std::size_t stations() const { return d1.size(); }
  double width(std::size_t i) const { return end[i] - begin[i]; }

  void reserve(std::size_t count);
  /// Adds the interval of a piece from `from` to `to`; the first call also adds the station where it begins.
  void add(const Path & path, std::size_t piece_index, double from, double to);
};

/// Speed, acceleration along the path at the stations of a grid, and the time each interval takes.
struct Profile {
  std::vector<double> v;  ///< ds/dt at each station
  std::vector<double>
      alpha;  ///< d2s/dt2 at each station; of the TOPP2 solver: in the interval that begins there
  std::vector<double> time;  ///< s, of each interval
};

/// `count` equal intervals in each piece of [first, last).
Grid uniform_grid(const Path & path, std::size_t first, std::size_t last, std::size_t count);

/// Stations at about equal intervals of time `step` by `profile`, whose acceleration is constant in each
/// interval of `coarse`; at least `least` intervals in a blend.
Grid time_spaced_grid(const Path & path, const Grid & coarse, const Profile & profile, double step,
                      std::size_t min_blend_intervals);

}  // namespace ur_ros_rtde::trajectory
