#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// How the controller's packages came during the last second. Thread-safe.
class PackageStatistics {
 public:
  struct Report {
    double rate = 0.0;           ///< Hz
    double mean_interval = 0.0;  ///< s
    double p99_interval = 0.0;   ///< s: 99 of 100 intervals are shorter, or as long
    double longest = 0.0;        ///< s
    std::uint64_t lost =
        0;  ///< of the last second: cycles that no package came for, by the controller's clock
    std::uint64_t lost_ever = 0;
    std::uint64_t received_ever = 0;
  };

  PackageStatistics();
  /// Allocates nothing. `frequency`: Hz, at which the controller sends.
  void add(const Sample & sample, double frequency);
  /// Since the report before.
  Report report();

 private:
  mutable std::mutex mutex_;
  std::vector<double> intervals_;  ///< s; of a fixed capacity
  std::vector<double> sorted_;
  std::chrono::steady_clock::time_point began_;
  std::chrono::steady_clock::time_point received_;
  double controller_time_ = 0.0;
  std::uint32_t link_ = 0;
  Report counts_;
};

}  // namespace ur_ros_rtde
