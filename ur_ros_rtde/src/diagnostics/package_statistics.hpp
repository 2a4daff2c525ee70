#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Statistics of the received packages over the last second. Thread-safe.
class PackageStatistics {
 public:
  struct Report {
    double rate = 0.0;           ///< Hz
    double mean_interval = 0.0;  ///< s
    double p99_interval = 0.0;   ///< s, 99th percentile
    double longest = 0.0;        ///< s
    std::uint64_t lost = 0;      ///< control cycles without a package in the last second, by controller time
    std::uint64_t lost_total = 0;
    std::uint64_t received_total = 0;
  };

  PackageStatistics();
  /// Does not allocate. `frequency`: rate at which the controller sends, Hz.
  void add(const Sample & sample, double frequency);
  /// Returns the statistics since the previous report.
  Report report();

 private:
  mutable std::mutex mutex_;
  std::vector<double> intervals_;  ///< s; of a fixed capacity
  std::vector<double> sorted_;
  std::chrono::steady_clock::time_point began_;
  std::chrono::steady_clock::time_point newest_;
  std::uint64_t received_ = 0;  ///< since began_
  double controller_time_ = 0.0;
  std::uint32_t link_ = 0;
  Report counts_;
};

}  // namespace ur_ros_rtde
