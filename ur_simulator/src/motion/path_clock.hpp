#pragma once

namespace ur_simulator {

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
  bool braking() const { return slowing_ > 0.0; }
  bool stopped() const { return rate_ <= 0.0; }

 private:
  double time_ = 0.0;
  double rate_ = 1.0;
  double slowing_ = 0.0;
};

}  // namespace ur_simulator
