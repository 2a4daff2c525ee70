#pragma once

#include <array>

namespace ur_simulator {

/// How a path of `length` is to be covered; the unit of length is the path's (m, or rad of the leading
/// joint).
struct PathTiming {
  double length = 0.0;
  double speed = 1.0;         ///< > 0
  double acceleration = 1.0;  ///< > 0
  /// The path goes on at this speed from something before it.
  double start_speed = 0.0;
  /// Blending in: while the path before runs out, for `ramp_time`, the speed grows no faster than in
  /// proportion to that time, and no more than `ramp_room` is covered.
  double ramp_time = 0.0;
  double ramp_room = 0.0;
  /// Blending out: the last `end_room` of the path, at most the half of it, is one even deceleration of
  /// `end_acceleration` at most.
  double end_room = 0.0;
  double end_acceleration = 1.0;
  /// So long before that deceleration the next motion may take over, so that it need not begin at all.
  double release_lead = 0.0;
};

/// Distance over time: ends at rest at the path's length, evenly accelerated between a few points in time.
class SpeedProfile {
 public:
  struct Sample {
    double distance;
    double speed;
  };

  SpeedProfile() = default;
  /// As fast as the timing allows. Where its acceleration does not suffice to end at the end from
  /// `start_speed`, more is used.
  explicit SpeedProfile(const PathTiming & timing);
  /// From the middle of the blend at its start to the middle of that at its end in `time`, keeping to the
  /// acceleration where that suffices; when the limits do not allow it, as fast as they do.
  static SpeedProfile in_time(PathTiming timing, double time, double speed_limit, double acceleration_limit);

  double duration() const { return duration_; }
  /// From when on the next motion may be blended in; without blending out the end.
  double release_time() const { return release_time_; }
  double acceleration() const { return acceleration_; }
  Sample at(double time) const;

 private:
  struct Phase {
    double duration = 0.0;
    double acceleration = 0.0;
  };

  bool lay(const PathTiming & timing, double ramp);
  double middle_to_middle(const PathTiming & timing) const;

  double length_ = 0.0;
  double start_speed_ = 0.0;
  double acceleration_ = 1.0;
  std::array<Phase, 5> phases_{};  ///< ramp, accelerate, cruise, decelerate, blend out
  double duration_ = 0.0;
  double release_time_ = 0.0;
};

}  // namespace ur_simulator
