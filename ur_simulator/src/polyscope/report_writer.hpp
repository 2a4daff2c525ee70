#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "log/event_log.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Flight reports, support files and saved logs: what PolyScope writes onto the controller's disk when it is
/// asked to. The disk is a map here; with a folder the files are written there too. One report at a time, in
/// simulated time.
class ReportWriter {
 public:
  /// How long they take, s of simulated time. A robot takes minutes.
  static constexpr double flight_report_time = 2.0;
  static constexpr double support_file_time = 3.0;

  ReportWriter(const ControllerState & state, const EventLog & log, std::string serial_number,
               std::string folder);

  /// `result` is asked each cycle until it has one: the reply of the dashboard.
  using Pending = std::function<std::optional<std::string>()>;
  /// "controller", "software", "system".
  Pending begin_flight_report(std::string_view type);
  /// A folder on the robot's disk: /programs, or relative to it.
  Pending begin_support_file(std::string_view folder);
  std::string save_log();

  const std::map<std::string, std::string> & files() const { return files_; }

 private:
  Pending after(double time, std::function<std::string()> finish);
  std::string finish_flight_report(const std::string & type);
  std::string finish_support_file(const std::string & folder);
  std::string describe(std::string_view type) const;
  std::string log_text() const;
  /// The reply when it cannot be written.
  std::optional<std::string> write(const std::string & name, const std::string & content);

  const ControllerState & state_;
  const EventLog & log_;
  std::string serial_number_;
  std::string folder_;
  std::map<std::string, std::string> files_;
  std::uint64_t reports_ = 0;
  double begun_ = 0.0;  ///< s, of the report that was asked for last
  double due_ = 0.0;    ///< s
};

}  // namespace ur_simulator
