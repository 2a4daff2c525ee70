#include "teleoperation/stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

namespace ur_ros_rtde {
namespace {
/// Weight of the newest interval between messages.
constexpr double period_weight = 0.2;

double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}
}  // namespace

void Stream::Latency::add(Clock::duration wait)
{
  ++count;
  sum += wait;
  longest = std::max(longest, wait);
}

std::string Stream::Latency::text() const
{
  if (count == 0) {
    return "no message was followed";
  }
  return fmt::format("{} messages, {:.1f} ms from message to command, {:.1f} ms at most", count,
                     1e3 * seconds(sum) / static_cast<double>(count), 1e3 * seconds(longest));
}

Stream::Stream(std::string topic, CommandHost & host, const TeleoperationOptions & options,
               std::unique_ptr<Follower> follower, LogFunction log)
    : topic_(std::move(topic)),
      host_(host),
      options_(options),
      follower_(std::move(follower)),
      log_(std::move(log)),
      thread_([this](const std::stop_token & stop) { serve(stop); })
{
}

Stream::~Stream()
{
  close();
}

void Stream::close()
{
  std::shared_ptr<StopRequest> stop_request;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    stop_request = stop_request_;
  }
  thread_.request_stop();
  if (stop_request) {
    stop_request->request(Error{ErrorCode::shutdown, "the node is being shut down"});
  }
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Stream::put(Expected<StreamTarget> target)
{
  {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const double interval = seconds(now - newest_.arrived);
    const bool first = newest_.number == 0 || interval > options_.timeout;
    // Of the first message's period nothing is known, and of the second's little.
    newest_.period =
        first ? 0.5 * options_.timeout : newest_.period + period_weight * (interval - newest_.period);
    newest_.burst += first ? 1 : 0;
    newest_.number += 1;
    newest_.arrived = now;
    newest_.target = std::move(target);
  }
  changed_.notify_all();
}

Stream::Message Stream::newest() const
{
  const std::lock_guard lock(mutex_);
  return newest_;
}

void Stream::serve(const std::stop_token & stop)
{
  std::uint64_t served = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [&] { return newest_.burst != served; }) || closed_) {
        return;
      }
      served = newest_.burst;
      stop_request_ = std::make_shared<StopRequest>();
    }
    Latency latency;
    log_end(live(served, latency), latency);
  }
}

Outcome Stream::live(std::uint64_t burst, Latency & latency)
{
  try {
    if (const Message first = newest(); !first.target) {
      return first.target.error();
    }
    if (const Status ready = host_.robot().ready_to_move(); !ready) {
      return ready;
    }
    const auto stop_request = [&] {
      const std::lock_guard lock(mutex_);
      return stop_request_;
    }();
    const auto lease = host_.robot().arbiter().acquire(
        {Resource::motion, topic_, "", [stop_request](const std::string & by) {
           stop_request->request(Error{ErrorCode::preempted, fmt::format("preempted by {}", by)});
         }});
    if (!lease) {
      return lease.error();
    }
    log_(LogLevel::info, fmt::format("{}: a stream begins", topic_));
    Run run(host_.robot(), stop_request, true);
    return stop(follow(run, burst, latency));
  } catch (const RobotError & error) {
    return error.error();
  } catch (const std::exception & error) {
    return Outcome::failure(ErrorCode::exception, error.what());
  }
}

Outcome Stream::stop(const Error & why) const
{
  StopOptions options{.joint_deceleration = options_.deceleration,
                      .linear_deceleration = options_.deceleration};
  if (why.code == ErrorCode::preempted) {
    options = host_.preemption_stop().value_or(options);
  }
  const auto stopped = host_.robot().stop_motion(options);
  return stopped ? Outcome(why)
                 : Outcome::failure(why.code, fmt::format("{}; standstill is not confirmed: {}", why.message,
                                                          stopped.error().message));
}

Error Stream::follow(Run & run, std::uint64_t burst, Latency & latency)
{
  try {
    const RealtimePriority priority(run.robot().realtime_priority());
    const auto version = run.robot().version();
    const double cycle = 1.0 / (version ? version->frequency() : 500.0);
    Sample sample = run.state();
    follower_->begin(sample, cycle, host_.limits());
    for (std::uint64_t taken = 0; true;) {
      const double before = sample.controller_time;
      if (auto why = run.next(sample)) {
        return *why;
      }
      const Message message = newest();
      const bool is_new = message.number != std::exchange(taken, message.number);
      if (const Status good = is_new ? aim(message, burst) : in_time(message, burst); !good) {
        return good.error();
      }
      // A host that was late goes on from where it was: the arm is slower then, never faster.
      const double elapsed = std::clamp(sample.controller_time - before, 0.0, 2.0 * cycle);
      if (const Status sent = follower_->advance(run, sample, elapsed); !sent) {
        return sent.error();
      }
      if (is_new) {
        latency.add(Clock::now() - message.arrived);
      }
    }
  } catch (const RobotError & error) {
    return error.error();
  } catch (const std::exception & error) {
    return {ErrorCode::exception, error.what()};
  }
}

Status Stream::in_time(const Message & message, std::uint64_t burst) const
{
  if (message.burst != burst || seconds(Clock::now() - message.arrived) > options_.timeout) {
    return failure(ErrorCode::timeout, fmt::format("no message came for {:.3g} s", options_.timeout));
  }
  return {};
}

Status Stream::aim(const Message & message, std::uint64_t burst) const
{
  if (const Status timely = in_time(message, burst); !timely) {
    return timely;
  }
  return message.target ? follower_->aim(*message.target, message.period)
                        : tl::unexpected(message.target.error());
}

void Stream::log_end(const Outcome & outcome, const Latency & latency) const
{
  if (outcome.code() == ErrorCode::timeout || outcome.code() == ErrorCode::shutdown) {
    log_(LogLevel::info,
         fmt::format("{}: the stream has ended: {}; {}", topic_, outcome.message(), latency.text()));
    return;
  }
  log_(LogLevel::warn,
       fmt::format("{}: the stream moves nothing: {} ({} {}); another one may begin after {:.3g} s without "
                   "messages",
                   topic_, outcome.message(), to_string(outcome.code()), static_cast<int>(outcome.code()),
                   options_.timeout));
}

}  // namespace ur_ros_rtde
