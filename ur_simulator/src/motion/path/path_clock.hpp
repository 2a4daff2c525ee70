#pragma once

namespace ur_simulator {

/// Time along a path. It runs at rate 1 until decelerate() is called; then the rate falls to 0, so that the
/// motion stops on its path.
class PathClock {
 public:
  /// Slows time down so that a path with this `speed` decelerates at `deceleration`.
  void decelerate(double speed, double deceleration);
  /// The rate falls in real time: the motion stops for any speed scaling.
  void advance(double duration, double speed_scaling);

  double time() const { return time_; }
  double rate() const { return rate_; }
  bool decelerating() const { return rate_deceleration_ > 0.0; }
  bool stopped() const { return rate_ <= 0.0; }

 private:
  double time_ = 0.0;
  double rate_ = 1.0;
  double rate_deceleration_ = 0.0;
};

}  // namespace ur_simulator
