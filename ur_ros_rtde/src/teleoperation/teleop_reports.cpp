#include "teleoperation/teleop_reports.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace ur_ros_rtde {

TeleopReports::TeleopReports(std::string topic, double pause, LogFunction log, Publish publish)
    : topic_(std::move(topic)), pause_(pause), log_(std::move(log)), publish_(std::move(publish))
{
}

void TeleopReports::publish(std::uint8_t state, const Error & why) const
{
  State message;
  message.topic = topic_;
  message.state = state;
  message.error_code = static_cast<std::uint16_t>(why.code);
  message.message = why.message;
  try {
    publish_(std::move(message));
  } catch (const std::exception & error) {  // the arm must be stopped all the same
    log_(LogLevel::warn,
         fmt::format("{}: the state of teleoperation cannot be published: {}", topic_, error.what()));
  }
}

void TeleopReports::started() const
{
  log_(LogLevel::info, fmt::format("{}: teleoperation started", topic_));
  publish(State::ACTIVE, {});
}

void TeleopReports::stopping(const Error & why) const
{
  publish(State::STOPPING, why);
}

void TeleopReports::ended(const Outcome & outcome, const std::string & statistics) const
{
  if (outcome.code() != ErrorCode::timeout && outcome.code() != ErrorCode::shutdown) {
    ignored({outcome.code(), outcome.message()});
    return;
  }
  log_(LogLevel::info, fmt::format("{}: teleoperation ended: {}; {}", topic_, outcome.message(), statistics));
  publish(State::IDLE, {outcome.code(), outcome.message()});
}

void TeleopReports::ignored(const Error & why) const
{
  log_(LogLevel::warn,
       fmt::format("{}: messages are ignored: {} ({} {}); teleoperation can start after {:.3g} s without "
                   "messages",
                   topic_, why.message, to_string(why.code), static_cast<int>(why.code), pause_));
  publish(State::IDLE, why);
}

void TeleopReports::hindered(const std::string & why) const
{
  log_(LogLevel::warn,
       fmt::format("{}: messages are ignored: {}; teleoperation starts with a message that commands no "
                   "motion: a zero twist, or twice the same target at the position of the arm",
                   topic_, why));
  publish(State::IDLE, {ErrorCode::not_ready, why});
}

}  // namespace ur_ros_rtde
