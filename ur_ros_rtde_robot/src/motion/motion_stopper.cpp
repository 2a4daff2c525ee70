// The requests of other threads, and the stopper's thread.
#include "motion/motion_stopper.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

/// For a holder that brakes by itself: to its first braking setpoint, and between two of them.
constexpr milliseconds braking_begin_timeout(10);
constexpr milliseconds braking_pause_timeout(25);
/// A holder is late if it is found to be late twice at this interval: this process may just not have run.
constexpr milliseconds supervision_interval(5);

StopOptions stronger(const StopOptions & a, const StopOptions & b)
{
  StopOptions result = a;
  result.joint_deceleration = std::max(a.joint_deceleration, b.joint_deceleration);
  result.linear_deceleration = std::max(a.linear_deceleration, b.linear_deceleration);
  result.timeout =
      a.timeout && b.timeout ? std::min(*a.timeout, *b.timeout) : (a.timeout ? a.timeout : b.timeout);
  result.keep = a.keep & b.keep;
  result.ends_foreign_program = a.ends_foreign_program || b.ends_foreign_program;
  return result;
}

Stopping completed(Expected<StopReport> result)
{
  std::promise<Expected<StopReport>> promise;
  promise.set_value(std::move(result));
  return promise.get_future().share();
}

}  // namespace

/// No claim is granted between the revocation of the permits and the beginning of the stop.
class MotionStopper::Beginning {
 public:
  explicit Beginning(MotionStopper & stopper) : stopper_(stopper)
  {
    const std::lock_guard lock(stopper_.mutex_);
    ++stopper_.beginning_;
  }
  ~Beginning()
  {
    {
      const std::lock_guard lock(stopper_.mutex_);
      --stopper_.beginning_;
    }
    stopper_.changed_.notify_all();
  }
  Beginning(const Beginning &) = delete;
  Beginning & operator=(const Beginning &) = delete;

 private:
  MotionStopper & stopper_;
};

MotionStopper::MotionStopper(const RobotOptions & options, const StateReceiver & state,
                             RtdeInterfaces & interfaces, InputRegisters & registers,
                             const MotionTracker & tracker, const StartedActivities & activities,
                             const Arbiter & arbiter, ProgramQueries program, LogFunction log)
    : options_(options),
      state_(state),
      interfaces_(interfaces),
      registers_(registers),
      tracker_(tracker),
      activities_(activities),
      arbiter_(arbiter),
      program_(std::move(program)),
      logger_(std::move(log)),
      last_(completed(StopReport{})),
      thread_([this](const std::stop_token & stop) { serve(stop); })
{
}

void MotionStopper::close()
{
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  thread_.request_stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

bool MotionStopper::is_stopping() const
{
  const std::lock_guard lock(mutex_);
  return operation_ || beginning_ > 0;
}

bool MotionStopper::wait_until_idle(Clock::time_point deadline, const std::stop_token & stop)
{
  std::unique_lock lock(mutex_);
  return changed_.wait_until(lock, stop, deadline, [this] { return !operation_ && beginning_ == 0; });
}

Stopping MotionStopper::begin(const StopOptions & options, const Error & why)
{
  Stopping stopping;
  decltype(arbiter_.arm_holders()) holders;
  {
    const Beginning beginning(*this);
    holders = arbiter_.arm_holders();
    std::erase_if(holders, [&](const auto & holder) { return !holder->revoke(why); });
    stopping = begin_operation(options);
  }
  for (const auto & holder : holders) {
    if (holder->claim().preempt) {
      holder->claim().preempt(why);
    }
  }
  return stopping;
}

Stopping MotionStopper::end(Permit & holder, const StopOptions & options)
{
  {
    const Beginning beginning(*this);
    if (holder.revoke(Error{ErrorCode::canceled, "this goal has ended"})) {
      return begin_operation(options);
    }
  }
  return current();
}

Stopping MotionStopper::pause(const Permit & holder, const StopOptions & options)
{
  return holder.revoked() ? current() : begin_operation(options);
}

std::optional<Status> MotionStopper::outcome(const Permit & holder) const
{
  const std::lock_guard lock(mutex_);
  if (operation_ || beginning_ > 0 || !holder.revoked()) {
    return std::nullopt;
  }
  const auto & last = last_.get();  // it is ready
  return last ? Status() : tl::unexpected(last.error());
}

Stopping MotionStopper::current()
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return beginning_ == 0; });  // by the one that has revoked the permit
  return operation_ ? operation_->stopping : last_;
}

void MotionStopper::request(const std::shared_ptr<Permit> & holder, const StopOptions & options,
                            const Error & why, milliseconds braking_timeout)
{
  if (holder->brakes_itself() && !holder->revoked()) {
    {
      const std::lock_guard lock(mutex_);
      const auto now = Clock::now();
      Supervision next{holder, options, why, now + braking_begin_timeout, now + braking_timeout};
      if (supervision_ && supervision_->holder == holder) {  // the first deadline applies
        next.begin_timeout = std::min(next.begin_timeout, supervision_->begin_timeout);
        next.end_limit = std::min(next.end_limit, supervision_->end_limit);
      }
      supervision_ = std::move(next);
    }
    changed_.notify_all();
    return;
  }
  const Beginning beginning(*this);
  const bool revoked_now = holder->revoke(why);
  if (holder->claim().resource == Resource::mode) {
    return;  // its holder does not own what moves the arm; its goal decides what to do
  }
  if (revoked_now) {
    begin_operation(options);
  } else {
    shorten(options.timeout);
  }
}

Stopping MotionStopper::begin_operation(const StopOptions & options)
{
  Stopping stopping;
  {
    const std::lock_guard lock(mutex_);
    if (closed_) {
      return completed(failure(ErrorCode::shutdown, "the driver is shutting down"));
    }
    require(options);
    stopping = operation_->stopping;
  }
  changed_.notify_all();
  return stopping;
}

void MotionStopper::require(const StopOptions & options)
{
  if (!operation_) {
    operation_ = std::make_unique<Operation>();
    operation_->options = options;
    return;
  }
  operation_->joined = true;
  const StopOptions joined = stronger(operation_->options, options);
  options_changed_ = options_changed_ || !(joined == operation_->options);
  operation_->options = joined;
}

void MotionStopper::shorten(const std::optional<milliseconds> & timeout)
{
  const std::lock_guard lock(mutex_);
  if (operation_ && timeout && (!operation_->options.timeout || *timeout < *operation_->options.timeout)) {
    StopOptions options = operation_->options;
    options.timeout = timeout;
    require(options);
  }
}

void MotionStopper::serve(const std::stop_token & stop)
{
  const RealtimePriority priority(options_.realtime_priority);
  std::unique_lock lock(mutex_);
  while (true) {
    const auto has_work = [this] { return operation_ && beginning_ == 0; };
    if (supervision_) {
      changed_.wait_for(lock, stop, supervision_interval, has_work);
    } else {
      changed_.wait(lock, stop, [&] { return has_work() || supervision_; });
    }
    if (has_work()) {
      execute_operation(lock);
    } else if (stop.stop_requested()) {
      return;
    } else if (supervision_) {
      supervise();
    }
  }
}

void MotionStopper::execute_operation(std::unique_lock<std::mutex> & lock)
{
  constexpr int most_failures = 2;  // of requests that never cease
  std::optional<Expected<StopReport>> result;
  int failures = 0;
  do {
    options_changed_ = false;
    operation_->joined = false;
    const StopOptions options = operation_->options;
    lock.unlock();
    auto pass = execute_guarded(options);
    const bool found_nothing = pass && pass->means == StopMeans::nothing_moved;
    if (!result || !*result || !found_nothing) {
      result = std::move(pass);
    }
    lock.lock();
    failures += *result || options_changed_ ? 0 : 1;
  } while (operation_->joined && failures < most_failures);
  last_ = operation_->stopping;
  operation_->promise.set_value(*result);
  operation_.reset();
  changed_.notify_all();
  lock.unlock();
  if (*result) {
    active_program_.reset();
    logger_.reset();
  } else {
    logger_.log_on_change(LogLevel::warn,
                          fmt::format("standstill is not confirmed: {}", result->error().message));
  }
  lock.lock();
}

Expected<StopReport> MotionStopper::execute_guarded(const StopOptions & options)
{
  try {
    return execute(options);
  } catch (const std::exception & error) {
    return failure(ErrorCode::exception, printable(error.what()));
  }
}

void MotionStopper::supervise()
{
  Supervision & now = *supervision_;
  if (now.holder->revoked()) {
    supervision_.reset();  // a stop has taken over
    return;
  }
  const auto time = Clock::now();
  const auto last = now.holder->last_braking();
  const bool is_late =
      time > now.end_limit || time > (last ? *last + braking_pause_timeout : now.begin_timeout);
  // A holder that has ended to stream what it can brake is stopped like any other.
  const bool has_to_stop = !now.holder->brakes_itself() || (is_late && now.is_late);
  now.is_late = is_late;
  if (!has_to_stop) {
    return;
  }
  const Supervision ended = *std::exchange(supervision_, std::nullopt);
  if (ended.holder->revoke(ended.why)) {
    require(ended.options);
  }
}

}  // namespace ur_ros_rtde
