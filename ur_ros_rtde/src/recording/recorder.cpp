#include "recording/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "recording/recording_session.hpp"
#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double highest_frequency = 500.0;  // Hz
const std::string timestamp = "timestamp";

Status check(const std::string & file, const std::vector<std::string> & fields, double frequency)
{
  if (file.empty() || file.front() != '/') {  // before the robot is asked
    return failure(ErrorCode::invalid_goal,
                   fmt::format("filename \"{}\" is relative: it has to begin with '/'", file));
  }
  if (!(frequency == 0.0 || (frequency >= 1.0 && frequency <= highest_frequency))) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("frequency is {} Hz: it may be 1 to {}, or 0 for the controller's", frequency,
                               highest_frequency));
  }
  return check_rtde_outputs(fields);
}

std::vector<std::string> columns_of(const std::vector<RtdeSubscription::Field> & fields)
{
  std::vector<std::string> columns;
  for (const auto & field : fields) {
    for (std::size_t i = 0; i < field.size; ++i) {
      columns.push_back(field.size == 1 ? field.name : fmt::format("{}_{}", field.name, i));
    }
  }
  return columns;
}
}  // namespace

Recorder::Recorder(std::string address, LogFunction log) : address_(std::move(address)), log_(std::move(log))
{
}

Recorder::~Recorder()
{
  if (const auto report = stop(); report && log_) {
    log_(LogLevel::info, fmt::format("recording {} ended with the node: {} rows, {} lost", report->file,
                                     report->rows, report->lost));
  }
}

Expected<std::vector<std::string>> Recorder::start(const std::string & file, std::vector<std::string> fields,
                                                   double frequency)
{
  const std::lock_guard lock(mutex_);
  if (session_) {
    return failure(ErrorCode::busy,
                   fmt::format("{} is being recorded: end that first (ur record --stop)", session_->path()));
  }
  if (fields.empty()) {
    fields = {timestamp, "actual_q", "actual_qd", "actual_TCP_pose"};
  }
  if (Status fits = check(file, fields, frequency); !fits) {
    return tl::unexpected(fits.error());
  }
  // Losses are detected by the timestamp. If it is not requested, it is the last field and not written.
  RecordingSession::Plan plan{address_, fields, frequency, 0, 0};
  if (std::ranges::find(fields, timestamp) == fields.end()) {
    plan.fields.push_back(timestamp);
  }
  auto subscription = RtdeSubscription::open(address_, plan.fields, frequency);
  if (!subscription) {
    return tl::unexpected(subscription.error());
  }
  plan.frequency = subscription->frequency();
  auto columns = columns_of(subscription->fields());
  plan.timestamp = static_cast<std::size_t>(std::ranges::find(columns, timestamp) - columns.begin());
  columns.resize(columns.size() - (plan.fields.size() - fields.size()));
  plan.columns = columns.size();
  auto csv = CsvFile::create(file, columns);
  if (!csv) {
    return tl::unexpected(csv.error());
  }
  session_ =
      std::make_unique<RecordingSession>(std::move(plan), std::move(*subscription), std::move(*csv), log_);
  return columns;
}

Expected<RecordingReport> Recorder::stop()
{
  const std::lock_guard lock(mutex_);
  if (!session_) {
    return failure(ErrorCode::not_ready, "nothing is being recorded");
  }
  RecordingReport report = session_->end();
  session_.reset();
  return report;
}

}  // namespace ur_ros_rtde
