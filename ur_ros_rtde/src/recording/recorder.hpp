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
  /// Packages that should have become rows and did not: by the controller's clock, so that those count, too,
  /// that came while the link was down, but not what went by while the controller was.
  std::uint64_t lost = 0;
  /// What kept it from writing on, if anything did: a full disk.
  Status state;
};

/// Writes RTDE fields into files, on a connection and threads of its own, so that neither the disk nor the
/// number of fields concerns anybody else. One recording at a time. Thread-safe.
class Recorder {
 public:
  Recorder(std::string address, LogFunction log);
  /// Ends a recording as stop() does.
  ~Recorder();
  Recorder(const Recorder &) = delete;
  Recorder & operator=(const Recorder &) = delete;

  /// Returns the columns: "timestamp", "actual_q_0", … `fields`: none: timestamp, actual_q, actual_qd,
  /// actual_TCP_pose. `frequency`: Hz; 0: the controller's. Takes some 10 ms. Errors: busy, invalid_goal,
  /// not_supported (fields that this controller does not have), link_lost.
  Expected<std::vector<std::string>> start(const std::string & file, std::vector<std::string> fields,
                                           double frequency);
  /// Errors: not_ready, when there is no recording.
  Expected<RecordingReport> stop();

 private:
  const std::string address_;
  const LogFunction log_;
  std::mutex mutex_;
  std::unique_ptr<RecordingSession> session_;
};

}  // namespace ur_ros_rtde
