// Receives the packages of one connection.
#include <fmt/format.h>
#include <ur_rtde/robot_state.h>

#include <algorithm>
#include <utility>

#include "state/state_receiver_impl.hpp"
#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"

namespace ur_ros_rtde {
namespace {
/// The end of the silence limit, reserved for reading packages that wait in the socket.
constexpr std::chrono::milliseconds reading_time(10);
}  // namespace

void StateReceiver::Impl::publish(Sample & sample, const SampleReader & reader)
{
  const auto last = std::pair(sample.received, sample.controller_time);
  sample.received = reader.read(sample);
  if (std::pair(sample.received, sample.controller_time) == last) {
    return;  // the first package, which ur_rtde's thread reports after it has been read here
  }
  ++sample.sequence;
  sample.stamp =
      std::chrono::system_clock::now() -
      std::chrono::duration_cast<std::chrono::system_clock::duration>(Clock::now() - sample.received);
  {
    const std::lock_guard lock(mutex_);
    latest_ = sample;
  }
  changed_.notify_all();
  if (sample_function_) {
    sample_function_(sample);
  }
}

/// Runs on ur_rtde's thread, which must not see an exception.
void StateReceiver::Impl::on_package(Sample & sample, const SampleReader & reader)
{
  processing_ = true;
  try {
    publish(sample, reader);
  } catch (const std::exception & error) {
    set_failure(error.what());
  } catch (...) {
    set_failure("unknown exception");
  }
  processed_ = Clock::now();
  processing_ = false;
}

/// ur_rtde cannot read packages while one is being processed; this must not count as silence of the
/// controller.
StateReceiver::Impl::Clock::time_point StateReceiver::Impl::last_activity(ur_rtde::RobotState & state) const
{
  return processing_ ? Clock::now() : std::max(state.getPackageTime(), processed_.load());
}

Error StateReceiver::Impl::monitor(const std::stop_token & stop, ur_rtde::RTDEReceiveInterface & interface)
{
  const auto state = interface.getRobotState();
  const auto silence_limit = ur_ros_rtde::silence_limit(options_.silence_limit, frequency_);
  // If this host was busy, packages may be waiting in the socket: the last part of the limit is reserved for
  // ur_rtde's thread to read them. After a longer delay of this host, the limit begins anew, once.
  const auto last_wait = std::min(reading_time, silence_limit / 2);
  Clock::time_point resumed;
  const auto left = [&] {
    return std::max(last_activity(*state), resumed) + silence_limit - last_wait - Clock::now();
  };
  while (!stop.stop_requested()) {
    const auto due = Clock::now() + std::max<Clock::duration>(left(), std::chrono::milliseconds(1));
    pause(stop, due - Clock::now());
    if (const auto now = Clock::now(); now - due > last_wait && last_activity(*state) > resumed) {
      resumed = now;
    }
    if (const auto failed = take_failure()) {
      return {ErrorCode::exception, fmt::format("a callback could not process a package: {}", *failed)};
    }
    if (!interface.isConnected()) {
      return {ErrorCode::link_lost, fmt::format("{} closed the RTDE connection", options_.address)};
    }
    if (left() <= Clock::duration::zero()) {
      pause(stop, last_wait);
      if (left() <= Clock::duration::zero()) {
        return {ErrorCode::link_lost,
                fmt::format(
                    "no RTDE package from {} for {} ms: the connection, the controller or this host hangs",
                    options_.address, silence_limit.count())};
      }
    }
  }
  return {ErrorCode::shutdown, "shutting down"};
}

void StateReceiver::Impl::pause(const std::stop_token & stop, Clock::duration timeout)
{
  std::unique_lock lock(mutex_);
  pause_.wait_for(lock, stop, timeout, [this] { return ended_ || failure_; });
}

void StateReceiver::Impl::set_failure(const char * what)
{
  {
    const std::lock_guard lock(mutex_);
    failure_ = what;
  }
  pause_.notify_all();
}

void StateReceiver::Impl::set_ended(bool ended)
{
  {
    const std::lock_guard lock(mutex_);
    ended_ = ended;
  }
  pause_.notify_all();
}

std::optional<std::string> StateReceiver::Impl::take_failure()
{
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

Error StateReceiver::Impl::receive_packages(const std::stop_token & stop)
{
  const auto interface = interface_;
  const auto state = interface->getRobotState();
  const SampleReader reader(state, options_.upper_range_registers ? 24 : 0, !version_->cb3());
  Sample sample = latest_;
  ++sample.link;
  on_package(sample, reader);
  set_link({true, {}});  // when there is a sample of this connection
  state->setPackageCallback([&] { on_package(sample, reader); }, [this] { set_ended(true); });
  const Error end = monitor(stop, *interface);
  state->setPackageCallback({});
  set_ended(false);
  take_failure();  // of a package that arrived in the meantime
  return end;
}

}  // namespace ur_ros_rtde
