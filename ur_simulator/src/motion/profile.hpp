#pragma once

namespace ur_simulator {

/// Distance over time from rest to rest: constant acceleration, constant speed, constant deceleration.
class TrapezoidProfile {
 public:
  struct Sample {
    double distance;
    double speed;
  };

  TrapezoidProfile() = default;
  /// As fast as `speed` and `acceleration` (both > 0) allow.
  TrapezoidProfile(double distance, double speed, double acceleration);
  /// In `time` when the limits allow, keeping to `acceleration` where that suffices; else as fast as the
  /// limits allow.
  static TrapezoidProfile in_time(double distance, double time, double acceleration, double speed_limit,
                                  double acceleration_limit);

  double duration() const { return 2.0 * ramp_time_ + cruise_time_; }
  double acceleration() const { return acceleration_; }
  Sample at(double time) const;

 private:
  double distance_ = 0.0;
  double acceleration_ = 1.0;
  double ramp_time_ = 0.0;
  double cruise_time_ = 0.0;
};

/// Time of a path that can be brought to a halt on it: runs at rate 1 until told to brake, then slows down to
/// 0.
class PathClock {
 public:
  /// `deceleration` over the `speed` of the path at this moment is how fast time slows down.
  void brake(double speed, double deceleration);
  /// The rate falls with real time, so that braking ends whatever the speed scaling is.
  void advance(double duration, double speed_scaling);

  double time() const { return time_; }
  double rate() const { return rate_; }
  bool stopped() const { return rate_ <= 0.0; }

 private:
  double time_ = 0.0;
  double rate_ = 1.0;
  double slowing_ = 0.0;
};

}  // namespace ur_simulator
