#include "robot_api/handlers.hpp"

namespace ur_simulator::robot_api {

Answer generate_flight_report(const Call & call)
{
  ReportWriter & reports = call.pendant.reports();
  if (reports.is_busy()) {
    return error_reply(429, "Too Many Requests", "another report is already being generated");
  }
  return [report = reports.start_flight_report("")]() -> std::optional<Reply> {
    const auto text = report();
    if (!text) {
      return std::nullopt;
    }
    if (ReportWriter::is_error(*text)) {
      return error_reply(507, "Insufficient storage to generate flight report.", *text);
    }
    return json_reply(200, {{"message", "Flight report generated successfully."}, {"details", *text}});
  };
}

Answer download_support_files(const Call & call)
{
  Reply reply;
  reply.body = call.pendant.reports().archive();
  reply.content_type = "application/zip";
  reply.status = reply.body.empty() ? 204 : 200;
  return reply;
}

}  // namespace ur_simulator::robot_api
