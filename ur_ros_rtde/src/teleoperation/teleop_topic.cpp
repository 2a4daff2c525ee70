#include "teleoperation/teleop_topic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "teleoperation/publisher_pause.hpp"
#include "ur_ros_rtde/detail/thread_name.hpp"
#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"

namespace ur_ros_rtde {
namespace {
/// Publishers that were there before the driver are found within this time.
constexpr std::chrono::seconds discovery_time{3};
/// The rate of a publisher may have been lower before its first message that arrived.
constexpr double rate_tolerance = 1.05;

double seconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}
}  // namespace

void TeleopTopic::Latency::add(Clock::duration wait)
{
  ++count;
  sum += wait;
  longest = std::max(longest, wait);
}

std::string TeleopTopic::Latency::text() const
{
  if (count == 0) {
    return "no message led to a command";
  }
  return fmt::format("{} messages, {:.1f} ms from message to command, {:.1f} ms at most", count,
                     1e3 * seconds(sum) / static_cast<double>(count), 1e3 * seconds(longest));
}

TeleopTopic::TeleopTopic(std::string topic, CommandHost & host, const StreamOptions & options,
                         std::unique_ptr<TargetFollower> follower, const LogFunction & log,
                         TeleopReports::Publish publish)
    : topic_(std::move(topic)),
      host_(host),
      options_(options),
      follower_(std::move(follower)),
      reports_(topic_, options.timeout, log, std::move(publish)),
      thread_([this](const std::stop_token & stop) { serve(stop); })
{
}

TeleopTopic::~TeleopTopic()
{
  close();
}

void TeleopTopic::stop(const Error & why)
{
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  thread_.request_stop();
  end_session(why);
}

void TeleopTopic::end_session(const Error & why)
{
  const std::lock_guard lock(mutex_);
  if (stop_request_ && stop_request_->request(why)) {
    host_.robot().request_stop(lease_, options_.stop_options(), why, {});
  }
}

void TeleopTopic::close()
{
  stop(Error{ErrorCode::shutdown, "the node is being shut down"});
  if (thread_.joinable()) {
    thread_.join();
  }
}

void TeleopTopic::on_message(Expected<StreamTarget> target, const rcl_cxx::MessageInfo & info)
{
  const auto sample = host_.robot().latest();
  Hindrance hindrance{};
  {
    const std::lock_guard lock(mutex_);
    Message next = following(std::move(target), info, sample);
    if (!next.session.is_reported && is_known(next)) {
      hindrance = next.session.hindrance;
      next.session.is_reported = true;
    }
    newest_ = std::move(next);
  }
  changed_.notify_all();
  report(hindrance);
}

TeleopTopic::Message TeleopTopic::following(Expected<StreamTarget> target, const rcl_cxx::MessageInfo & info,
                                            const std::optional<Sample> & sample) const
{
  Message next;
  next.arrived = Clock::now();
  next.number = newest_.number + 1;
  next.info = info;
  const double interval = seconds(next.arrived - newest_.arrived);
  const Session & before = newest_.session;
  const bool was_stopped = host_.stops() != before.stops;
  const bool paused = newest_.number == 0 || has_paused(newest_.info, info, options_.timeout);
  const bool first = newest_.number == 0 ||
                     (interval > options_.timeout && (paused || (!was_stopped && !before.needs_pause)));
  next.period = newest_.period;
  next.period.next(interval, options_.timeout);
  const StreamTarget * const last = newest_.target ? &*newest_.target : nullptr;
  next.moves = target && sample ? follower_->moves(*target, last, *sample) : newest_.moves;
  next.target = std::move(target);
  if (first) {
    next.session = {.number = before.number + 1,
                    .stops = host_.stops(),
                    .first = info,
                    .silent_since = newest_.number == 0 ? created_ : newest_.arrived,
                    .follows_pause = paused};
    next.session.hindrance = hindrance_of_first(next, was_stopped);
    return next;
  }
  next.session = before;
  next.session.hindrance = hindrance_of_following(next, was_stopped);
  if (next.session.hindrance != before.hindrance) {
    next.session.is_reported = false;
  }
  if (next.session.may_start() && !before.may_start()) {
    next.session.stops = host_.stops();
  }
  return next;
}

TeleopTopic::Hindrance TeleopTopic::hindrance_of_first(const Message & next, bool was_stopped) const
{
  if (!next.target || !next.moves) {
    return Hindrance::none;
  }
  if (newest_.number > 0 && next.info.publisher == newest_.info.publisher) {
    return newest_.moves || was_stopped ? Hindrance::gap : Hindrance::none;
  }
  // A publisher that counts its messages shows its age later. A session that was hindered has not begun.
  const bool was_ended = newest_.number > 0 && (was_stopped || newest_.session.needs_pause ||
                                                newest_.session.hindrance != Hindrance::none);
  const bool is_soon = next.arrived - next.session.silent_since < discovery_time;
  const bool may_be_old = was_ended ? next.info.number || is_soon : newest_.number == 0 && is_soon;
  return may_be_old && next.info.number != 1u ? Hindrance::publisher : Hindrance::none;
}

TeleopTopic::Hindrance TeleopTopic::hindrance_of_following(const Message & next, bool was_stopped) const
{
  if (newest_.session.may_start()) {
    return Hindrance::none;
  }
  if (was_stopped) {
    return Hindrance::stop;
  }
  const auto age = age_of_publisher(next.session.first, next.info, options_.timeout);
  const bool is_new = newest_.session.hindrance == Hindrance::publisher && age &&
                      rate_tolerance * *age < seconds(next.arrived - next.session.silent_since);
  return is_new || !next.moves ? Hindrance::none : newest_.session.hindrance;
}

bool TeleopTopic::is_known(const Message & message) const
{
  return message.session.hindrance != Hindrance::publisher || !message.info.number ||
         age_of_publisher(message.session.first, message.info, options_.timeout);
}

TeleopTopic::Message TeleopTopic::newest() const
{
  const std::lock_guard lock(mutex_);
  return newest_;
}

void TeleopTopic::serve(const std::stop_token & stop)
{
  name_thread("stream " + topic_);
  std::uint64_t served = 0;
  while (true) {
    rcl_cxx::PublisherId publisher{};
    {
      std::unique_lock lock(mutex_);
      const auto starts = [&] { return newest_.session.number != served && newest_.session.may_start(); };
      if (!changed_.wait(lock, stop, starts) || closed_) {
        return;
      }
      served = newest_.session.number;
      publisher = newest_.session.first.publisher;
      stop_request_ = std::make_shared<StopRequest>();
    }
    Latency latency;
    const Outcome outcome = run_session(served, latency);
    if (outcome.code() != ErrorCode::timeout) {
      served = require_pause(served, publisher);
    }
    reports_.ended(outcome, latency.text());
  }
}

std::uint64_t TeleopTopic::require_pause(std::uint64_t session, const rcl_cxx::PublisherId & publisher)
{
  const std::lock_guard lock(mutex_);
  Session & newest = newest_.session;
  const bool is_known = newest.first.publisher == publisher || newest.first.number == 1u;
  if (newest.number != session && newest.follows_pause && is_known) {
    return session;
  }
  newest.needs_pause = true;
  return newest.number;
}

Outcome TeleopTopic::run_session(std::uint64_t session, Latency & latency)
{
  try {
    const Message first = newest();
    if (!first.target) {
      return first.target.error();
    }
    Claim claim;
    claim.owner = topic_;
    claim.preempt = [this](const Error & why) { end_session(why); };
    auto lease = host_.robot().acquire(std::move(claim));
    if (!lease) {
      return lease.error();
    }
    if (host_.stops() != first.session.stops) {
      return stopped_by_the_driver();  // after the session had begun
    }
    if (const Status free = host_.may_move(); !free) {
      return free;
    }
    std::shared_ptr<StopRequest> stop_request;
    {
      const std::lock_guard lock(mutex_);
      lease_ = std::move(*lease);
      stop_request = stop_request_;
    }
    reports_.started();
    Run run(RunContext{host_.robot(), stop_request, &lease_});
    const Activities before = host_.robot().activities() & outlasting_modes;
    const Error why = follow(run, session, latency);
    reports_.stopping(why);
    const Outcome outcome = settle(why, before);
    lease_.release();
    return outcome;
  } catch (const RobotError & error) {
    return error.error();
  } catch (const std::exception & error) {
    return Outcome::failure(ErrorCode::exception, error.what());
  }
}

Outcome TeleopTopic::settle(const Error & why, Activities active_before) const
{
  StopOptions options = options_.stop_options();
  if (why.code == ErrorCode::timeout) {  // the regular end
    options.keep = active_before;
  }
  const auto stopped = host_.robot().end_motion(lease_, options);
  return stopped ? why : standstill_not_confirmed(why, stopped.error());
}

Error TeleopTopic::follow(Run & run, std::uint64_t session, Latency & latency)
{
  try {
    const RealtimePriority priority(run.robot().realtime_priority());
    TargetStream stream(run, *follower_, options_);
    for (std::uint64_t last_number = 0; true;) {
      if (auto why = stream.wait()) {
        return *why;
      }
      const Message message = newest();
      const bool is_new = message.number != std::exchange(last_number, message.number);
      if (const Status valid =
              is_new ? set_target(stream, message, session) : check_timeout(message, session);
          !valid) {
        return valid.error();
      }
      if (const Status sent = stream.send(); !sent) {
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

Status TeleopTopic::check_timeout(const Message & message, std::uint64_t session) const
{
  if (message.session.number != session || seconds(Clock::now() - message.arrived) > options_.timeout) {
    return failure(ErrorCode::timeout, fmt::format("no message was received for {:.3g} s", options_.timeout));
  }
  return {};
}

Status TeleopTopic::set_target(TargetStream & stream, const Message & message, std::uint64_t session) const
{
  if (const Status timely = check_timeout(message, session); !timely) {
    return timely;
  }
  return message.target ? stream.set(*message.target, message.period.seconds())
                        : tl::unexpected(message.target.error());
}

void TeleopTopic::report(Hindrance hindrance) const
{
  switch (hindrance) {
    case Hindrance::none:
      break;
    case Hindrance::stop:
      reports_.ignored(stopped_by_the_driver());
      break;
    case Hindrance::publisher:
      reports_.hindered(
          "their publisher may have been there before the last session ended, or before the driver");
      break;
    case Hindrance::gap:
      reports_.hindered(
          fmt::format("there was none for more than {:.3g} s while they moved the arm", options_.timeout));
      break;
  }
}

}  // namespace ur_ros_rtde
