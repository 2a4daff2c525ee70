#pragma once

#include <limits>
#include <stop_token>
#include <utility>

namespace ur_ros_rtde::trajectory {

/// Processor time of the calling thread, s.
double thread_time();

/// When the search for a faster motion has to end. What has been found by then keeps the limits. It counts
/// the processor time of the thread that plans, so the same goal gives the same motion on a busy host.
class SearchLimit {
 public:
  SearchLimit() = default;
  /// `seconds` from now, of the calling thread.
  SearchLimit(std::stop_token stop, double seconds) : stop_(std::move(stop)), end_(thread_time() + seconds) {}

  bool is_reached() const { return stop_.stop_requested() || thread_time() >= end_; }

 private:
  std::stop_token stop_;
  double end_ = std::numeric_limits<double>::infinity();
};

}  // namespace ur_ros_rtde::trajectory
