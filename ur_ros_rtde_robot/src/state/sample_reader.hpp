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

/// Copies the package that ur_rtde received last into a Sample, all of it under one lock. The names are
/// looked up once, so that a package costs no allocation here.
class SampleReader {
 public:
  /// Variables that `state` does not hold are NaN or 0 in the samples. `register_offset`: 0, or 24 for the
  /// upper range.
  SampleReader(std::shared_ptr<ur_rtde::RobotState> state, int register_offset);
  ~SampleReader();

  /// When the package arrived.
  std::chrono::steady_clock::time_point read(Sample & sample) const;

 private:
  std::shared_ptr<ur_rtde::RobotState> state_;
  std::vector<std::function<void(Sample &)>> copies_;
};

}  // namespace ur_ros_rtde
