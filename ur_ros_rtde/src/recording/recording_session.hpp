#pragma once

#include <atomic>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "recording/csv_file.hpp"
#include "recording/recorder.hpp"
#include "recording/row_queue.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"

namespace ur_ros_rtde {

/// An active recording: one thread receives packages and reconnects after a lost connection, another one
/// writes the file.
class RecordingSession {
 public:
  struct Plan {
    std::string address;
    std::vector<std::string> fields;  ///< "timestamp" is one of them
    double frequency;                 ///< Hz, agreed
    std::size_t columns;              ///< number of values of a package that are written to a row
    std::size_t timestamp;            ///< its index in a row
  };

  RecordingSession(Plan plan, RtdeSubscription subscription, CsvFile file, const LogFunction & log);
  ~RecordingSession();
  const std::string & path() const { return file_.path(); }
  /// Writes the remaining rows and closes the file. Call it once.
  RecordingReport end();

 private:
  void receive(const std::stop_token & stop);
  Status follow(const std::stop_token & stop);
  void take(std::span<const double> numbers);
  void write();

  const Plan plan_;
  ChangeLogger logger_;
  RtdeSubscription subscription_;
  CsvFile file_;
  Status state_;  ///< used by the writer thread until it has ended
  RowQueue queue_;
  double last_ = 0.0;  ///< timestamp
  bool has_last_ = false;
  std::atomic<std::uint64_t> lost_ = 0;
  std::jthread writer_;
  std::jthread receiver_;
};

}  // namespace ur_ros_rtde
