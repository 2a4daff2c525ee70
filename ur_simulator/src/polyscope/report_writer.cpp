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

ReportWriter::Pending at_once(std::string reply)
{
  return [reply = std::move(reply)]() -> std::optional<std::string> { return reply; };
}

constexpr std::string_view programs = "/programs";

}  // namespace

ReportWriter::ReportWriter(const ControllerState & state, const EventLog & log, std::string serial_number,
                           std::string folder)
    : state_(state), log_(log), serial_number_(std::move(serial_number)), folder_(std::move(folder))
{
}

ReportWriter::Pending ReportWriter::begin_flight_report(std::string_view type)
{
  constexpr std::array<std::string_view, 3> types{"controller", "software", "system"};
  if (std::ranges::find(types, type) == types.end()) {
    return at_once(fmt::format("Error: Flight Report type '{}' is not one of {}", type,
                               fmt::join(types.begin(), types.end(), ", ")));
  }
  return after(flight_report_time, [this, name = std::string(type)] { return finish_flight_report(name); });
}

ReportWriter::Pending ReportWriter::begin_support_file(std::string_view folder)
{
  std::string_view inside = folder;
  if (inside.starts_with(programs)) {
    inside.remove_prefix(programs.size());
  }
  const bool known = inside.empty() || inside == "/" || inside == ".";
  if (!known) {
    return at_once(fmt::format("Error: Directory does not exist: {}", folder));
  }
  return after(support_file_time, [this] { return finish_support_file(std::string(programs)); });
}

ReportWriter::Pending ReportWriter::after(double time, std::function<std::string()> finish)
{
  // By the clock, which a reboot sets back: the client that asked may be gone before its report is done.
  const double now = state_.timestamp;
  if (now >= begun_ && now < due_) {
    return at_once("Error: Another report is already being generated");
  }
  begun_ = now;
  due_ = now + time;
  return [this, due = due_, finish = std::move(finish)]() -> std::optional<std::string> {
    return state_.timestamp < due ? std::nullopt : std::optional(finish());
  };
}

std::string ReportWriter::finish_flight_report(const std::string & type)
{
  const std::uint64_t id = ++reports_;
  const std::string name = fmt::format("flightreports/{}_{}.txt", id, type);
  const auto failure = write(name, describe(type));
  return failure ? *failure : fmt::format("Flight Report generated with id: {}", id);
}

std::string ReportWriter::finish_support_file(const std::string & folder)
{
  const std::string report = finish_flight_report("system");
  if (report.starts_with("Error")) {
    return report;
  }
  std::vector<std::pair<std::string, std::string>> content;
  for (const auto & [name, text] : files_) {
    if (!name.ends_with(".zip")) {
      content.emplace_back(name, text);
    }
  }
  const std::string name =
      fmt::format("ur_{}_{:%Y-%m-%d_%H-%M-%S}.zip", serial_number_, fmt::gmtime(std::time(nullptr)));
  const auto failure = write(name, zip_archive(content));
  return failure ? *failure : fmt::format("Completed successfully: {}/{}", folder, name);
}

std::string ReportWriter::save_log()
{
  const auto failure = write("log_history.txt", log_text());
  return failure ? *failure : "Log saved to disk";
}

std::string ReportWriter::describe(std::string_view type) const
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
    text +=
        fmt::format("{:10.3f} {:7} {:10} {}\n", entry.timestamp, name(entry.level), entry.source, entry.text);
  }
  return text;
}

std::optional<std::string> ReportWriter::write(const std::string & name, const std::string & content)
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
