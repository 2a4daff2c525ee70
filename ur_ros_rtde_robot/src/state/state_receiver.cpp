#include "ur_ros_rtde_robot/state/state_receiver.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "connection/ports.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "state/sample_reader.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double highest_frequency = 500.0;
constexpr std::chrono::milliseconds longest_wait(10);

void check(const StateReceiverOptions & options)
{
  if (options.realtime_priority < 0 || options.realtime_priority > 99) {
    throw std::invalid_argument(fmt::format("realtime_priority is {}: it must be from 1 to 99, or 0 for none",
                                            options.realtime_priority));
  }
  if (options.address.empty()) {
    throw std::invalid_argument("the robot's address is empty: give its IP address or host name");
  }
  const double frequency = options.frequency;
  if (!(frequency == 0.0 || (frequency >= 1.0 && frequency <= highest_frequency))) {
    throw std::invalid_argument(
        fmt::format("frequency is {} Hz: it must be from 1 to {} Hz, or 0 for the controller's own",
                    frequency, highest_frequency));
  }
}

}  // namespace

class StateReceiver::Impl {
 public:
  Impl(StateReceiverOptions options, LogFunction log) : options_(std::move(options)), logger_(std::move(log))
  {
    check(options_);
    link_.error = {ErrorCode::link_lost, fmt::format("connecting to {}", options_.address)};
  }

  void run(const std::stop_token & stop);
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;

  SampleFunction sample_function_;
  LinkFunction link_function_;

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  std::condition_variable_any pause_;  ///< never notified, only for waits with a stop token
  LinkStatus link_;
  std::optional<ControllerVersion> version_;
  double frequency_ = 0.0;
  Sample latest_{};
  std::shared_ptr<ur_rtde::RTDEReceiveInterface> interface_;

  std::jthread thread_;

 private:
  Status connect();
  Error connect_and_receive(const std::stop_token & stop);
  Error receive_packages(const std::stop_token & stop);
  /// Returns when the connection fails or a stop is requested.
  Error monitor(const std::stop_token & stop, ur_rtde::RTDEReceiveInterface & interface);
  Clock::time_point last_activity(ur_rtde::RobotState & state) const;
  void on_package(Sample & sample, const SampleReader & reader);
  void publish(Sample & sample, const SampleReader & reader);
  void pause(const std::stop_token & stop, Clock::duration limit);
  std::optional<std::string> take_failure();
  void set_link(LinkStatus status);
  double choose_frequency(const ControllerVersion & version);

  const StateReceiverOptions options_;
  std::optional<std::string> failure_;  ///< exception of sample_function_
  std::atomic<bool> processing_ = false;
  std::atomic<Clock::time_point> processed_{};
  ChangeLogger logger_;
  bool frequency_reported_ = false;
  std::shared_ptr<InterfaceLock> lock_ = std::make_shared<InterfaceLock>();
};

double StateReceiver::Impl::choose_frequency(const ControllerVersion & version)
{
  if (options_.frequency == 0.0) {
    return version.frequency();
  }
  if (options_.frequency > version.frequency() && !std::exchange(frequency_reported_, true)) {
    logger_.log(LogLevel::warn,
                fmt::format("frequency {} Hz exceeds the maximum of a controller of version {}: using {} Hz",
                            options_.frequency, to_string(version), version.frequency()));
  }
  return std::min(options_.frequency, version.frequency());
}

Status StateReceiver::Impl::connect()
{
  const auto version = probe_rtde(options_.address, options_.connect_timeout);
  if (!version) {
    return tl::unexpected(version.error());
  }
  const double frequency = choose_frequency(*version);
  try {
    auto interface = std::make_shared<ur_rtde::RTDEReceiveInterface>(
        options_.address, frequency, std::vector<std::string>{}, false, options_.upper_range_registers,
        keep_priority);
    if (!interface->isConnected()) {
      return failure(ErrorCode::link_lost, fmt::format("{}:{} accepts the RTDE set-up but sends no data",
                                                       options_.address, rtde_port));
    }
    const std::lock_guard lock(mutex_);
    interface_ = std::move(interface);
    version_ = *version;
    frequency_ = frequency;
    return {};
  } catch (const std::exception & error) {
    return failure(ErrorCode::link_lost,
                   fmt::format("the RTDE server at {}:{} does not follow the protocol: {}", options_.address,
                               rtde_port, printable(error.what())));
  }
}

void StateReceiver::Impl::publish(Sample & sample, const SampleReader & reader)
{
  const auto arrival = reader.read(sample);
  ++sample.sequence;
  sample.received = arrival;
  sample.stamp = std::chrono::system_clock::now() -
                 std::chrono::duration_cast<std::chrono::system_clock::duration>(Clock::now() - arrival);
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
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = "unknown exception";
  }
  processed_ = Clock::now();
  processing_ = false;
}

/// ur_rtde cannot read packages while one is being processed; this must not count as silence of the
/// controller.
Clock::time_point StateReceiver::Impl::last_activity(ur_rtde::RobotState & state) const
{
  return processing_ ? Clock::now() : std::max(state.getPackageTime(), processed_.load());
}

Error StateReceiver::Impl::monitor(const std::stop_token & stop, ur_rtde::RTDEReceiveInterface & interface)
{
  const auto state = interface.getRobotState();
  const auto silence_limit =
      std::max(options_.silence_limit,
               std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(5.0 / frequency_)));
  // If this host was busy, packages may be waiting in the socket: the last part of the limit is reserved for
  // ur_rtde's thread to read them.
  const auto last_wait = std::min(longest_wait, silence_limit / 2);
  const auto left = [&] { return last_activity(*state) + silence_limit - last_wait - Clock::now(); };
  while (!stop.stop_requested()) {
    pause(stop, std::clamp<Clock::duration>(left(), std::chrono::milliseconds(1), longest_wait));
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
                fmt::format("no RTDE package from {} for {} ms: the connection or the controller hangs",
                            options_.address, silence_limit.count())};
      }
    }
  }
  return {ErrorCode::shutdown, "shutting down"};
}

void StateReceiver::Impl::pause(const std::stop_token & stop, Clock::duration limit)
{
  std::unique_lock lock(mutex_);
  pause_.wait_for(lock, stop, limit, [] { return false; });
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
  const SampleReader reader(state, options_.upper_range_registers ? 24 : 0);
  Sample sample = latest_;
  ++sample.link;
  on_package(sample, reader);
  set_link({true, {}});  // when there is a sample of this connection
  state->setPackageCallback([&] { on_package(sample, reader); });
  const Error end = monitor(stop, *interface);
  state->setPackageCallback({});
  return end;
}

void StateReceiver::Impl::set_link(LinkStatus status)
{
  bool changed = false;
  // Destroyed without the lock, since this closes the connection and joins a thread.
  std::shared_ptr<ur_rtde::RTDEReceiveInterface> dropped;
  {
    const std::lock_guard lock(mutex_);
    if (!status.connected) {
      dropped = std::exchange(interface_, nullptr);
    }
    changed = link_.connected != status.connected || link_.error.message != status.error.message;
    link_ = status;
  }
  changed_.notify_all();
  dropped.reset();
  if (changed && link_function_) {
    link_function_(status);
  }
}

void StateReceiver::Impl::run(const std::stop_token & stop)
{
  // ur_rtde's threads inherit the priority.
  if (const Status allowed = set_realtime_priority(options_.realtime_priority); !allowed) {
    logger_.log(LogLevel::warn, allowed.error().message);
  }
  const auto retry_seconds = std::chrono::duration<double>(options_.retry_interval).count();
  while (!stop.stop_requested()) {
    const Error end = connect_and_receive(stop);
    set_link({false, end});
    pause(stop, options_.retry_interval);
    if (!stop.stop_requested()) {  // no error message if driver and controller are shut down together
      logger_.log_on_change(LogLevel::error,
                            fmt::format("{}. Trying again every {} s", end.message, retry_seconds));
    }
  }
}

Error StateReceiver::Impl::connect_and_receive(const std::stop_token & stop)
{
  if (const auto connected = connect(); !connected) {
    return connected.error();
  }
  logger_.reset();
  logger_.log(LogLevel::info, fmt::format("connected to {}: PolyScope {}, {} Hz", options_.address,
                                          to_string(*version_), frequency_));
  return receive_packages(stop);
}

Locked<ur_rtde::RTDEReceiveInterface> StateReceiver::Impl::receive() const
{
  const std::lock_guard lock(mutex_);
  if (!link_.connected || !interface_) {
    throw RobotError(link_.error);
  }
  return {interface_, lock_, "receive interface"};
}

StateReceiver::StateReceiver(StateReceiverOptions options, LogFunction log)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(log)))
{
}

StateReceiver::~StateReceiver()
{
  stop();
}

void StateReceiver::on_sample(SampleFunction function)
{
  impl_->sample_function_ = std::move(function);
}

void StateReceiver::on_link(LinkFunction function)
{
  impl_->link_function_ = std::move(function);
}

void StateReceiver::start()
{
  if (!impl_->thread_.joinable()) {
    impl_->thread_ = std::jthread([impl = impl_.get()](const std::stop_token & stop) { impl->run(stop); });
  }
}

void StateReceiver::stop()
{
  if (impl_->thread_.joinable()) {
    impl_->thread_.request_stop();
    impl_->thread_.join();
  }
}

LinkStatus StateReceiver::link() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->link_;
}

std::optional<ControllerVersion> StateReceiver::version() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->version_;
}

double StateReceiver::frequency() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->frequency_;
}

std::optional<Sample> StateReceiver::latest() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->latest_.sequence == 0 ? std::nullopt : std::optional(impl_->latest_);
}

bool StateReceiver::wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop) const
{
  std::unique_lock lock(impl_->mutex_);
  const bool newer =
      impl_->changed_.wait_for(lock, stop, limit, [&] { return impl_->latest_.sequence > last.sequence; });
  if (newer) {
    last = impl_->latest_;
  }
  return newer;
}

Locked<ur_rtde::RTDEReceiveInterface> StateReceiver::receive() const
{
  return impl_->receive();
}

}  // namespace ur_ros_rtde
