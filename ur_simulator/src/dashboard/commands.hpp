#pragma once

#include <span>
#include <string>
#include <string_view>

#include "polyscope/pendant.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::dashboard {

/// One command of the Dashboard Server, as in UR's "Dashboard Server e-Series" and "CB-Series" manuals.
struct Command {
  std::string_view name;  ///< matched without regard to case; what follows it is the argument
  Since since;
  bool needs_remote_control;  ///< refused by an e-Series in local control
  std::string (*reply)(Pendant & pendant, std::string_view argument);
  /// In the place of `reply` where the answer may take its time; asked each cycle until there is one.
  ReportWriter::Pending (*begin)(Pendant & pendant, std::string_view argument) = nullptr;
};

// Those that take their time.
ReportWriter::Pending play(Pendant & pendant, std::string_view argument);
ReportWriter::Pending generate_flight_report(Pendant & pendant, std::string_view type);
ReportWriter::Pending generate_support_file(Pendant & pendant, std::string_view folder);

/// All commands except quit and shutdown's effect on the connection, which the server carries out.
std::span<const Command> commands();

/// The command that the line begins with, the longest name winning, or nullptr; `argument` is the trimmed
/// rest.
const Command * find_command(std::string_view line, const PolyscopeVersion & version,
                             std::string_view & argument);

}  // namespace ur_simulator::dashboard
