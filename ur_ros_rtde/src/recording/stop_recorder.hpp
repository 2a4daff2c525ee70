#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "recording/csv_file.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// The folder of the log files, as rcl_logging chooses it: ROS_LOG_DIR, or log in ROS_HOME, or ~/.ros/log.
std::filesystem::path log_folder();

/// Keeps the samples of the last seconds. After a protective stop, a violation or a fault, writes them to a
/// CSV file that `ur plot` draws, with the names of the RTDE outputs as columns. The newest max_files files
/// are kept.
class StopRecorder {
 public:
  static constexpr double time_before = 2.0;  ///< s of the controller's time, before the stop
  static constexpr double time_after = 0.2;   ///< s, from the stop on
  static constexpr std::size_t max_files = 20;

  /// `folder` is created for the first file. `name`: of the robot, in the file names. `log`: gets the path of
  /// each file, or why it was not written.
  StopRecorder(std::filesystem::path folder, std::string name, LogFunction log);
  /// Discards a stop that is not written yet and joins the thread.
  ~StopRecorder();
  StopRecorder(const StopRecorder &) = delete;
  StopRecorder & operator=(const StopRecorder &) = delete;

  /// Called with each sample by one thread. Does not allocate and does not wait for the disk.
  void add(const Sample & sample);

 private:
  static constexpr std::size_t columns = 56;
  using Row = std::array<double, columns>;

  struct Stop {
    SafetyMode mode;
    double time;  ///< s, of the controller
  };

  static std::vector<std::string> column_names();
  static Row row_of(const Sample & sample);
  void serve(const std::stop_token & stop);
  void write_complete();
  /// Returns the path. `around`: the rows around the stop, oldest first.
  Expected<std::string> write(const Stop & stop, const std::vector<Row> & around) const;
  void remove_old_files(const std::filesystem::path & newest) const;

  const std::filesystem::path folder_;
  const std::string name_;
  const LogFunction log_;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<Row> ring_;
  std::size_t next_ = 0;
  SafetyMode last_mode_ = SafetyMode::undefined;
  std::uint32_t last_link_ = 0;
  std::optional<Stop> stop_;      ///< since which samples are collected
  std::optional<Stop> complete_;  ///< to be written
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
