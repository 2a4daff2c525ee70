#pragma once

#include <array>

namespace ur_simulator {

/// Constraints of a speed profile over a path of `length`. The unit of length is that of the path (m, or rad
/// of the leading joint).
struct ProfileConstraints {
  double length = 0.0;
  double speed = 1.0;         ///< highest, > 0
  double acceleration = 1.0;  ///< highest, > 0
  double start_speed = 0.0;   ///< the path continues another one at this speed
  /// Blending in: during `blend_in_time`, while the previous path decelerates, the speed grows linearly and
  /// at most `blend_in_distance` is covered.
  double blend_in_time = 0.0;
  double blend_in_distance = 0.0;
  /// Blending out: over the last `blend_out_distance`, at most half of the path, the deceleration is constant
  /// and at most `blend_out_acceleration`.
  double blend_out_distance = 0.0;
  double blend_out_acceleration = 1.0;
  /// The next motion may take over this time before the deceleration of the blend begins; s.
  double blend_start_lead = 0.0;
};

/// Distance over time: piecewise constant acceleration, ends at rest at the end of the path.
class SpeedProfile {
 public:
  struct Sample {
    double distance;
    double speed;
  };

  SpeedProfile() = default;
  /// The fastest profile within the constraints. The acceleration is exceeded where it would not suffice to
  /// stop at the end from `start_speed`.
  explicit SpeedProfile(const ProfileConstraints & constraints);
  /// A profile that takes `duration` from the middle of the blend at its start to the middle of the blend at
  /// its end. It keeps the acceleration if that suffices, else uses up to `acceleration_limit`. If the limits
  /// do not allow the duration, it is as fast as they allow.
  static SpeedProfile with_duration(ProfileConstraints constraints, double duration, double speed_limit,
                                    double acceleration_limit);

  double duration() const { return duration_; }
  /// Time from which the next motion may be blended in; the duration if there is no blend at the end.
  double blend_start_time() const { return blend_start_time_; }
  double acceleration() const { return acceleration_; }
  Sample sample(double time) const;

 private:
  struct Phase {
    double duration = 0.0;
    double acceleration = 0.0;
  };

  /// False if the constraints cannot be kept with this acceleration in the blend at the start.
  bool build(const ProfileConstraints & constraints, double blend_in_acceleration);
  /// Adds the last phase, which decelerates from `speed` over `distance`, and sets the times that follow.
  void finish_with_blend(double distance, double speed, double lead_distance);
  double duration_between_blend_middles(const ProfileConstraints & constraints) const;

  double length_ = 0.0;
  double start_speed_ = 0.0;
  double acceleration_ = 1.0;
  std::array<Phase, 5> phases_{};  ///< blend in, accelerate, cruise, decelerate, blend out
  double duration_ = 0.0;
  double blend_start_time_ = 0.0;
};

}  // namespace ur_simulator
