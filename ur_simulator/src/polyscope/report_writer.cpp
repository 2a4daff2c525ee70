#include "polyscope/report_writer.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "polyscope/zip_file.hpp"

namespace ur_simulator {
namespace {

PendingReply immediate_reply(std::string reply)
{
  return [reply = std::move(reply)]() -> std::optional<std::string> { return reply; };
}

constexpr std::string_view programs_folder = "/programs";

}  // namespace

ReportWriter::ReportWriter(const ControllerState & state, const EventLog & log, std::string serial_number,
                           std::string folder)
    : state_(state), log_(log), serial_number_(std::move(serial_number)), folder_(std::move(folder))
{
}

PendingReply ReportWriter::start_flight_report(std::string_view type)
{
  constexpr std::string_view default_type = "system";
  if (type.empty()) {
    type = default_type;
  }
  constexpr std::array<std::string_view, 3> types{"controller", "software", "system"};
  if (std::ranges::find(types, type) == types.end()) {
    return immediate_reply(fmt::format("Error: Flight Report type '{}' is not one of {}", type,
                                       fmt::join(types.begin(), types.end(), ", ")));
  }
  return start_report(flight_report_duration,
                      [this, name = std::string(type)] { return finish_flight_report(name); });
}

PendingReply ReportWriter::start_support_file(std::string_view folder)
{
  std::string_view inside = folder;
  if (inside.starts_with(programs_folder)) {
    inside.remove_prefix(programs_folder.size());
  }
  const bool known = inside.empty() || inside == "/" || inside == ".";
  if (!known) {
    return immediate_reply(fmt::format("Error: Directory does not exist: {}", folder));
  }
  return start_report(support_file_duration,
                      [this] { return finish_support_file(std::string(programs_folder)); });
}

PendingReply ReportWriter::start_report(double duration, std::function<std::string()> finish)
{
  // Whether a report is being generated depends on the simulated time only, because the client may disconnect
  // before the report is finished. A reboot resets the time and ends the report.
  const double now = state_.timestamp;
  if (is_busy()) {
    return immediate_reply("Error: Another report is already being generated");
  }
  report_started_ = now;
  report_finished_ = now + duration;
  return [this, finish_time = report_finished_, finish = std::move(finish)]() -> std::optional<std::string> {
    return state_.timestamp < finish_time ? std::nullopt : std::optional(finish());
  };
}

std::string ReportWriter::finish_flight_report(const std::string & type)
{
  const std::uint64_t id = ++report_count_;
  const std::string name = fmt::format("flightreports/{}_{}.txt", id, type);
  const auto failure = write_file(name, flight_report_text(type));
  return failure ? *failure : fmt::format("Flight Report generated with id: {}", id);
}

std::string ReportWriter::finish_support_file(const std::string & folder)
{
  const std::string report = finish_flight_report("system");
  if (is_error(report)) {
    return report;
  }
  const std::string name =
      fmt::format("ur_{}_{:%Y-%m-%d_%H-%M-%S}.zip", serial_number_, fmt::gmtime(std::time(nullptr)));
  const auto failure = write_file(name, archive());
  return failure ? *failure : fmt::format("Completed successfully: {}/{}", folder, name);
}

bool ReportWriter::is_busy() const
{
  return state_.timestamp >= report_started_ && state_.timestamp < report_finished_;
}

std::string ReportWriter::archive() const
{
  std::vector<std::pair<std::string, std::string>> content;
  for (const auto & [name, text] : files_) {
    if (!name.ends_with(".zip")) {
      content.emplace_back(name, text);
    }
  }
  return content.empty() ? "" : zip_archive(content);
}

std::string ReportWriter::save_log()
{
  const auto failure = write_file("log_history.txt", log_text());
  return failure ? *failure : "Log saved to disk";
}

std::string ReportWriter::flight_report_text(std::string_view type) const
{
  return fmt::format(
      "Flight report: {}\nserial number: {}\ntime: {:.3f} s\nrobot mode: {}\nsafety mode: {}\n\n{}", type,
      serial_number_, state_.timestamp, to_string(state_.robot_mode), to_string(state_.safety_mode),
      log_text());
}

std::string ReportWriter::log_text() const
{
  std::string text;
  for (const LogEntry & entry : log_.entries()) {
    text += to_string(entry) + "\n";
  }
  return text;
}

std::optional<std::string> ReportWriter::write_file(const std::string & name, const std::string & content)
{
  files_.insert_or_assign(name, content);
  if (folder_.empty()) {
    return std::nullopt;
  }
  const std::filesystem::path path = std::filesystem::path(folder_) / name;
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  std::ofstream file(path, std::ios::binary);
  file << content;
  file.close();
  if (!file) {
    return fmt::format("Error: {} cannot be written", path.string());
  }
  return std::nullopt;
}

}  // namespace ur_simulator
