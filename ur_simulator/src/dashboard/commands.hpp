#pragma once

#include <span>
#include <string>
#include <string_view>

#include "polyscope/pendant.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::dashboard {

/// A command of the dashboard server (UR, "Dashboard Server e-Series" and "Dashboard Server CB-Series").
struct Command {
  std::string_view name;  ///< case-insensitive; the rest of the line is the argument
  MinVersion min_version;
  bool requires_remote_control;  ///< e-Series controllers reject it in local control
  /// Executes the command and returns its reply.
  std::string (*execute)(Pendant & pendant, std::string_view argument);
  /// Set instead of `execute` for commands whose reply may take several control cycles.
  PendingReply (*start)(Pendant & pendant, std::string_view argument) = nullptr;
};

/// `done`, or that the command has failed.
std::string reply_to(const Pendant::Result & result, std::string_view done, std::string_view command);

// Commands whose reply may take several control cycles.
PendingReply play(Pendant & pendant, std::string_view argument);
/// "returns when stopping is completed", "… pausing …" (UR, "Dashboard Server", from CB3 3.3 on).
PendingReply stop(Pendant & pendant, std::string_view argument);
PendingReply pause(Pendant & pendant, std::string_view argument);
PendingReply generate_flight_report(Pendant & pendant, std::string_view type);
PendingReply generate_support_file(Pendant & pendant, std::string_view folder);

/// Returns the command with the longest name with which the line begins, or nullptr. `argument` is set to the
/// rest of the line without surrounding blanks.
const Command * find_command(std::string_view line, const PolyscopeVersion & version,
                             std::string_view & argument);

}  // namespace ur_simulator::dashboard
