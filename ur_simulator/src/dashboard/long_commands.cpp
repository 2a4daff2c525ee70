#include <memory>
#include <optional>

#include "dashboard/commands.hpp"

namespace ur_simulator::dashboard {

ReportWriter::Pending play(Pendant & pendant, std::string_view)
{
  auto reply = std::make_shared<std::optional<std::string>>();
  if (pendant.manual()) {
    pendant.log().error("dashboard", "play was refused: the operational mode is MANUAL");
    *reply = "Failed to execute: play";
  } else {
    pendant.play([reply](const Pendant::Answer & answer) {
      *reply = answer ? "Starting program" : "Failed to execute: play";
    });
  }
  return [reply] { return *reply; };
}

ReportWriter::Pending generate_flight_report(Pendant & pendant, std::string_view type)
{
  return pendant.reports().begin_flight_report(type);
}

ReportWriter::Pending generate_support_file(Pendant & pendant, std::string_view folder)
{
  return pendant.reports().begin_support_file(folder);
}

}  // namespace ur_simulator::dashboard
