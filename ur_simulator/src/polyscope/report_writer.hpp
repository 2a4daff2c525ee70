#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "log/event_log.hpp"
#include "polyscope/pending_reply.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Writes the flight reports, support files and saved logs that the dashboard server requests. The files are
/// kept in memory and, if a folder is given, also written to it. Reports take simulated time; only one report
/// is generated at a time.
class ReportWriter {
 public:
  /// Duration of the generation, s of simulated time. A robot takes minutes.
  static constexpr double flight_report_duration = 2.0;
  static constexpr double support_file_duration = 3.0;

  /// `folder` may be empty.
  ReportWriter(const ControllerState & state, const EventLog & log, std::string serial_number,
               std::string folder);

  /// `type` is "controller", "software", "system" or empty: "system", the dashboard server's default (UR,
  /// ur_dashboard_msgs, GenerateFlightReport.srv).
  PendingReply start_flight_report(std::string_view type);
  /// `folder` is a folder on the robot's disk: /programs, or relative to it.
  PendingReply start_support_file(std::string_view folder);
  /// Returns the dashboard reply.
  std::string save_log();
  /// Whether a report is being generated.
  bool is_busy() const;
  /// Whether a reply reports a failure.
  static bool is_error(std::string_view reply) { return reply.starts_with("Error"); }
  /// A ZIP archive with all reports and logs; "" if there are none.
  std::string archive() const;

 private:
  PendingReply start_report(double duration, std::function<std::string()> finish);
  std::string finish_flight_report(const std::string & type);
  std::string finish_support_file(const std::string & folder);
  std::string flight_report_text(std::string_view type) const;
  std::string log_text() const;
  /// Returns the error reply if the file cannot be written.
  std::optional<std::string> write_file(const std::string & name, const std::string & content);

  const ControllerState & state_;
  const EventLog & log_;
  std::string serial_number_;
  std::string folder_;
  std::map<std::string, std::string> files_;
  std::uint64_t report_count_ = 0;
  double report_started_ = 0.0;   ///< start of the last report, s
  double report_finished_ = 0.0;  ///< end of the last report, s
};

}  // namespace ur_simulator
