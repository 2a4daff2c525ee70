#include "recording/recording_session.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace ur_ros_rtde {
namespace {
using Clock = RtdeSubscription::Clock;

/// 8 s at 500 Hz, to bridge delays of the disk.
constexpr std::size_t queue_rows = 4000;
constexpr std::chrono::milliseconds poll_interval{50};
constexpr std::chrono::milliseconds min_silence_limit{1000};
constexpr std::chrono::milliseconds retry_interval{250};
}  // namespace

RecordingSession::RecordingSession(Plan plan, RtdeSubscription subscription, CsvFile file,
                                   const LogFunction & log)
    : plan_(std::move(plan)),
      logger_(log),
      subscription_(std::move(subscription)),
      file_(std::move(file)),
      queue_(plan_.columns, queue_rows),
      writer_([this] { write(); }),
      receiver_([this](const std::stop_token & stop) { receive(stop); })
{
}

RecordingSession::~RecordingSession()
{
  if (receiver_.joinable()) {
    end();
  }
}

RecordingReport RecordingSession::end()
{
  receiver_.request_stop();
  receiver_.join();
  queue_.close();
  writer_.join();
  if (state_) {
    state_ = file_.close();
  }
  return {file_.path(), file_.rows(), lost_, state_};
}

void RecordingSession::receive(const std::stop_token & stop)
{
  while (!stop.stop_requested()) {
    const Status ended = follow(stop);
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, stop, retry_interval, [] { return false; });
    if (stop.stop_requested()) {
      return;
    }
    logger_.log_on_change(LogLevel::warn, fmt::format("recording {}: {}; trying to connect again",
                                                      file_.path(), ended.error().message));
    if (auto subscription = RtdeSubscription::open(plan_.address, plan_.fields, plan_.frequency)) {
      subscription_ = std::move(*subscription);
      logger_.reset();
    }
  }
}

Status RecordingSession::follow(const std::stop_token & stop)
{
  std::vector<double> numbers(subscription_.width());
  const auto silence_limit = subscription_.silence_limit(min_silence_limit);
  auto last = Clock::now();
  while (!stop.stop_requested()) {
    const auto got = subscription_.next(numbers, Clock::now() + poll_interval);
    if (!got) {
      return tl::unexpected(got.error());
    }
    if (*got) {
      last = Clock::now();
      take(numbers);
    } else if (Clock::now() - last > silence_limit) {
      return failure(ErrorCode::link_lost, fmt::format("{} has stopped sending data", plan_.address));
    }
  }
  return {};
}

void RecordingSession::take(std::span<const double> numbers)
{
  const double now = numbers[plan_.timestamp];
  const double periods = std::round((now - last_) * plan_.frequency);
  if (has_last_ && periods > 1.0) {
    lost_ += static_cast<std::uint64_t>(periods) - 1;
  }
  has_last_ = true;
  last_ = now;
  if (!queue_.push(numbers.first(plan_.columns))) {
    ++lost_;
  }
}

void RecordingSession::write()
{
  std::vector<double> rows;
  rows.reserve(plan_.columns * queue_rows);
  while (queue_.take(rows)) {
    const std::size_t count = rows.size() / plan_.columns;
    const std::uint64_t before = file_.rows();
    if (state_) {
      for (std::size_t i = 0; i < count; ++i) {
        file_.append(std::span(rows).subspan(i * plan_.columns, plan_.columns));
      }
      state_ = file_.flush();
      if (!state_) {
        logger_.log(LogLevel::error, fmt::format("recording: {}", state_.error().message));
      }
    }
    lost_ += count - (file_.rows() - before);
  }
}

}  // namespace ur_ros_rtde
