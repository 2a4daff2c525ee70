#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"

namespace ur_ros_rtde {
namespace {

/// Weight of the newest interval in the smoothed period.
constexpr double period_weight = 0.2;
/// A longer gap between two packages counts as this many cycles.
constexpr double max_cycles = SetpointClock::bridged_cycles;
/// The default of Locked.
constexpr std::chrono::milliseconds max_control_timeout{5000};

double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

double TargetPeriod::next(double interval, double timeout)
{
  // Unknown at the first target, and uncertain at the second.
  const bool first = period_ == 0.0 || interval > timeout;
  period_ = first ? 0.5 * timeout : period_ + period_weight * (interval - period_);
  return period_;
}

TargetStream::TargetStream(Run & run, std::unique_ptr<TargetFollower> follower, const StreamOptions & options)
    : TargetStream(run, *follower, options)
{
  own_follower_ = std::move(follower);
}

TargetStream::TargetStream(Run & run, TargetFollower & follower, const StreamOptions & options)
    : run_(run),
      follower_(follower),
      options_(options),
      cycle_(run.robot().cycle_time()),
      sample_(run.state())
{
  follower_.begin(sample_, cycle_, run.robot().limits());
  control_timeout_ = run.exchange_control_timeout(
      std::min(max_control_timeout,
               std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(options.timeout))));
}

TargetStream::~TargetStream()
{
  run_.exchange_control_timeout(control_timeout_);
  try {
    if (const auto stopped =
            run_.stop_reason() ? Outcome::success() : run_.stop_motion(options_.stop_options());
        !stopped) {
      run_.warn(stopped.message());
    }
  } catch (const std::exception & error) {
    run_.warn(error.what());
  }
}

std::optional<StopReason> TargetStream::wait()
{
  const double before = sample_.controller_time;
  auto why = run_.next(sample_);
  elapsed_ = std::clamp(sample_.controller_time - before, 0.0, max_cycles * cycle_);
  return why;
}

Status TargetStream::set(const StreamTarget & target)
{
  const double interval = seconds(Clock::now() - last_target_);
  return set(target, period_.next(interval, options_.timeout));
}

Status TargetStream::set(const StreamTarget & target, double period)
{
  last_target_ = Clock::now();
  has_target_ = true;
  return follower_.set_target(target, period);
}

Status TargetStream::send()
{
  if (seconds(Clock::now() - last_target_) > options_.timeout) {
    return failure(ErrorCode::timeout,
                   fmt::format("there has been no target for {:.3g} s", options_.timeout));
  }
  return has_target_ ? follower_.advance(run_, sample_, elapsed_) : Status();
}

}  // namespace ur_ros_rtde
