#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

namespace ur_ros_rtde {

/// A bounded queue of rows from one thread to another. Does not allocate after both buffers have been used.
/// Thread-safe.
class RowQueue {
 public:
  RowQueue(std::size_t width, std::size_t most) : width_(width), most_(most) { rows_.reserve(width * most); }

  /// False if the queue is full; the row is lost.
  bool push(std::span<const double> row)
  {
    {
      const std::lock_guard lock(mutex_);
      if (rows_.size() >= width_ * most_) {
        return false;
      }
      rows_.insert(rows_.end(), row.begin(), row.end());
    }
    changed_.notify_one();
    return true;
  }

  /// Waits for rows and moves all of them to `rows`, concatenated. False if the queue was closed and is
  /// empty.
  bool take(std::vector<double> & rows)
  {
    rows.clear();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !rows_.empty(); });
    rows.swap(rows_);
    return !rows.empty();
  }

  /// Ends take() after the remaining rows.
  void close()
  {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

 private:
  const std::size_t width_;
  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<double> rows_;
  bool closed_ = false;
};

}  // namespace ur_ros_rtde
