#pragma once

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Judges from the controller's targets, which contain no noise, whether a stop takes effect.
class DecelerationCheck {
 public:
  /// s of the controller, in which the arm has to become slower.
  static constexpr double window = 0.06;

  /// False if neither the joints nor the TCP have become slower in the last window.
  [[nodiscard]] bool add(const Sample & sample);

 private:
  struct Speeds {
    double joint = 0.0;  ///< rad/s, of the fastest joint
    double tcp = 0.0;    ///< m/s
  };
  static Speeds speeds(const Sample & sample);

  bool begun_ = false;
  double begin_ = 0.0;
  Speeds at_begin_;
};

}  // namespace ur_ros_rtde
