#include "recording/stop_recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

namespace ur_ros_rtde {
namespace {
constexpr double max_frequency = 500.0;  // Hz
constexpr auto rows =
    static_cast<std::size_t>((StopRecorder::time_before + StopRecorder::time_after) * max_frequency) + 1;
constexpr std::string_view prefix = "ur_stop_";

struct VectorColumn {
  const char * name;
  Vector6 Sample::* values;
};

constexpr VectorColumn vectors[] = {
    {"target_q", &Sample::target_q},
    {"target_qd", &Sample::target_qd},
    {"target_current", &Sample::target_current},
    {"actual_q", &Sample::actual_q},
    {"actual_qd", &Sample::actual_qd},
    {"actual_current", &Sample::actual_current},
    {"actual_TCP_pose", &Sample::actual_tcp_pose},
    {"wrench_at_TCP", &Sample::actual_tcp_force},
};

struct NumberColumn {
  const char * name;
  double (*value)(const Sample & sample);
};

template <auto member>
double number(const Sample & sample)
{
  return static_cast<double>(sample.*member);
}

constexpr NumberColumn numbers[] = {
    {"robot_mode", number<&Sample::robot_mode>},
    {"safety_mode", number<&Sample::safety_mode>},
    {"safety_status_bits", number<&Sample::safety_status_bits>},
    {"runtime_state", number<&Sample::runtime_state>},
    {"speed_scaling", number<&Sample::speed_scaling>},
    {"target_speed_fraction", number<&Sample::target_speed_fraction>},
    {"payload", number<&Sample::payload>},
};

bool is_recorded(SafetyMode mode)
{
  return mode == SafetyMode::protective_stop || mode == SafetyMode::violation || mode == SafetyMode::fault;
}

std::filesystem::path from_environment(const char * name)
{
  const char * value = std::getenv(name);
  return value == nullptr ? "" : value;
}
}  // namespace

std::filesystem::path log_folder()
{
  const auto home = from_environment("HOME");
  if (auto folder = from_environment("ROS_LOG_DIR"); !folder.empty()) {
    return std::filesystem::absolute(*folder.begin() == "~" ? home / folder.lexically_relative("~") : folder);
  }
  const auto ros_home = from_environment("ROS_HOME");
  return std::filesystem::absolute((ros_home.empty() ? home / ".ros" : ros_home) / "log");
}

StopRecorder::StopRecorder(std::filesystem::path folder, std::string name, LogFunction log)
    : folder_(std::move(folder)),
      name_(std::move(name)),
      log_(std::move(log)),
      ring_(rows),
      thread_([this](const std::stop_token & stop) { serve(stop); })
{
}

StopRecorder::~StopRecorder() = default;

std::vector<std::string> StopRecorder::column_names()
{
  std::vector<std::string> names{"timestamp"};
  for (const auto & [name, values] : vectors) {
    for (int i = 0; i < 6; ++i) {
      names.push_back(fmt::format("{}_{}", name, i));
    }
  }
  for (const auto & [name, value] : numbers) {
    names.emplace_back(name);
  }
  return names;
}

StopRecorder::Row StopRecorder::row_of(const Sample & sample)
{
  static_assert(columns == 1 + 6 * std::size(vectors) + std::size(numbers));
  Row row;
  auto next = row.begin();
  *next++ = sample.controller_time;
  for (const auto & [name, values] : vectors) {
    next = std::copy((sample.*values).begin(), (sample.*values).end(), next);
  }
  for (const auto & [name, value] : numbers) {
    *next++ = value(sample);
  }
  return row;
}

void StopRecorder::add(const Sample & sample)
{
  const std::lock_guard lock(mutex_);
  const bool same_link = sample.link == std::exchange(last_link_, sample.link);
  const SafetyMode before = std::exchange(last_mode_, sample.safety_mode);
  if (!same_link && stop_) {  // the connection has broken soon after it
    complete_ = std::exchange(stop_, std::nullopt);
    changed_.notify_all();
  }
  if (complete_) {
    return;  // the rows are kept until the thread has them
  }
  ring_[next_] = row_of(sample);
  next_ = (next_ + 1) % ring_.size();
  if (same_link && !stop_ && is_recorded(sample.safety_mode) && !is_recorded(before)) {
    stop_ = Stop{sample.safety_mode, sample.controller_time};
  }
  if (stop_ && sample.controller_time >= stop_->time + time_after) {
    complete_ = std::exchange(stop_, std::nullopt);
    changed_.notify_all();
  }
}

void StopRecorder::serve(const std::stop_token & stop)
{
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [&] { return complete_.has_value(); })) {
        complete_ = std::exchange(stop_, std::nullopt);  // so far
        if (!complete_) {
          return;
        }
      }
    }
    try {
      write_complete();
    } catch (const std::exception & error) {
      log_(LogLevel::warn, fmt::format("the states before a stop were not written: {}", error.what()));
      const std::lock_guard lock(mutex_);
      complete_.reset();
    }
  }
}

void StopRecorder::write_complete()
{
  std::vector<Row> around;
  around.reserve(ring_.size());
  Stop stop{};
  {
    const std::lock_guard lock(mutex_);
    const auto oldest = ring_.begin() + static_cast<std::ptrdiff_t>(next_);
    around.insert(around.end(), oldest, ring_.end());
    around.insert(around.end(), ring_.begin(), oldest);
    stop = *std::exchange(complete_, std::nullopt);
  }
  // The controller's time begins again when it restarts. Unused rows have the time 0.
  std::erase_if(around, [&](const Row & row) {
    return !(row[0] > 0.0 && row[0] >= stop.time - time_before && row[0] <= stop.time + time_after);
  });
  const auto path = write(stop, around);
  log_(path ? LogLevel::info : LogLevel::warn,
       path ? fmt::format("the {:g} s before the {} are in {}: draw them with `ur plot`", time_before,
                          to_string(stop.mode), *path)
            : fmt::format("the {:g} s before the {} were not recorded: {}", time_before, to_string(stop.mode),
                          path.error().message));
}

Expected<std::string> StopRecorder::write(const Stop & stop, const std::vector<Row> & around) const
{
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    return failure(ErrorCode::exception,
                   fmt::format("{} cannot be created: {}", folder_.string(), error.message()));
  }
  const std::tm now = fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now()));
  const auto path =
      folder_ / fmt::format("{}{:%Y%m%d-%H%M%S}_{}_{}.csv", prefix, now, name_, to_string(stop.mode));
  auto file = CsvFile::create(path.string(), column_names());
  if (!file) {
    return tl::unexpected(file.error());
  }
  for (const Row & row : around) {
    file->append(row);
  }
  if (const Status closed = file->close(); !closed) {
    return tl::unexpected(closed.error());
  }
  remove_old_files(path);
  return path.string();
}

void StopRecorder::remove_old_files(const std::filesystem::path & newest) const
{
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto & entry : std::filesystem::directory_iterator(folder_, error)) {
    if (entry.path() != newest && entry.path().filename().string().starts_with(prefix)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), std::greater<>());  // the names begin with the time
  for (std::size_t i = max_files - 1; i < files.size(); ++i) {
    std::filesystem::remove(files[i], error);
  }
}

}  // namespace ur_ros_rtde
