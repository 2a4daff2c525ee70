#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_rtde {
class RobotState;
}

namespace ur_ros_rtde {

/// Copies the last package that ur_rtde received into a Sample, under one lock. The constructor looks up the
/// names, so that reading does not allocate.
class SampleReader {
 public:
  /// Variables that `state` lacks are NaN or 0 in the samples. `register_offset`: 0, or 24 for the upper
  /// range. `force_is_at_flange`: actual_TCP_force is, as on e-Series.
  SampleReader(std::shared_ptr<ur_rtde::RobotState> state, int register_offset, bool force_is_at_flange);
  ~SampleReader();

  /// Returns the arrival time of the package.
  std::chrono::steady_clock::time_point read(Sample & sample) const;

 private:
  std::shared_ptr<ur_rtde::RobotState> state_;
  std::vector<std::function<void(Sample &)>> copies_;
  const bool force_is_at_flange_;
};

}  // namespace ur_ros_rtde
