#include "diagnostics/package_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ur_ros_rtde {
namespace {
/// 2 s at 500 Hz. Further intervals are ignored until the next report, but counted.
constexpr std::size_t capacity = 1000;
}  // namespace

PackageStatistics::PackageStatistics() : began_(std::chrono::steady_clock::now())
{
  intervals_.reserve(capacity);
  sorted_.reserve(capacity);
}

void PackageStatistics::add(const Sample & sample, double frequency)
{
  const std::lock_guard lock(mutex_);
  ++counts_.received_total;
  if (counts_.received_total > 1 && sample.link == link_) {
    ++received_;
    if (intervals_.size() < capacity) {
      intervals_.push_back(std::chrono::duration<double>(sample.received - newest_).count());
    }
    const double cycles = std::round((sample.controller_time - controller_time_) * frequency);
    if (cycles > 1.0) {
      const auto lost = static_cast<std::uint64_t>(cycles) - 1;
      counts_.lost += lost;
      counts_.lost_total += lost;
    }
  }
  if (sample.link != link_) {  // the rate is that since the connection
    began_ = sample.received;
    received_ = 0;
    intervals_.clear();
  }
  link_ = sample.link;
  newest_ = sample.received;
  controller_time_ = sample.controller_time;
}

PackageStatistics::Report PackageStatistics::report()
{
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  Report report = counts_;
  report.rate = static_cast<double>(received_) / std::chrono::duration<double>(now - began_).count();
  if (!intervals_.empty()) {
    sorted_ = intervals_;
    std::ranges::sort(sorted_);
    report.mean_interval =
        std::accumulate(sorted_.begin(), sorted_.end(), 0.0) / static_cast<double>(sorted_.size());
    // The smallest interval that at least 99 % do not exceed.
    report.p99_interval = sorted_[(99 * sorted_.size() + 99) / 100 - 1];
    report.longest = sorted_.back();
  }
  counts_.lost = 0;
  received_ = 0;
  intervals_.clear();
  began_ = now;
  return report;
}

}  // namespace ur_ros_rtde
