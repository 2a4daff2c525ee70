#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

class RecordingSession;

struct RecordingReport {
  std::string file;
  std::uint64_t rows = 0;
  /// Rows that are missing, by controller time. Includes cycles while the connection was lost, but not the
  /// time while the controller was off.
  std::uint64_t lost = 0;
  /// The error that ended writing, for example a full disk.
  Status state;
};

/// Records RTDE fields to CSV files. Uses its own connection and threads, so that neither the disk nor the
/// number of fields affects the driver. One recording at a time. Thread-safe.
class Recorder {
 public:
  Recorder(std::string address, LogFunction log);
  /// Calls stop().
  ~Recorder();
  Recorder(const Recorder &) = delete;
  Recorder & operator=(const Recorder &) = delete;

  /// Starts a recording and returns its columns: "timestamp", "actual_q_0", … Empty `fields`: timestamp,
  /// actual_q, actual_qd, actual_TCP_pose. `frequency`: Hz; 0: rate of the controller. Takes about 10 ms.
  /// Errors: busy, invalid_goal, not_supported (the controller does not have a field), link_lost.
  Expected<std::vector<std::string>> start(const std::string & file, std::vector<std::string> fields,
                                           double frequency);
  /// Error: not_ready if there is no recording.
  Expected<RecordingReport> stop();

 private:
  const std::string address_;
  const LogFunction log_;
  std::mutex mutex_;
  std::unique_ptr<RecordingSession> session_;
};

}  // namespace ur_ros_rtde
