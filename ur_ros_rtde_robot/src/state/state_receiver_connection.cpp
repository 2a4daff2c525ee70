// Connects to the controller, again and again.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "connection/ports.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "state/state_receiver_impl.hpp"
#include "ur_ros_rtde_robot/connection/realtime_priority.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

constexpr double highest_frequency = 500.0;

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

StateReceiver::Impl::Impl(StateReceiverOptions options, LogFunction log)
    : options_(std::move(options)), retry_(options_.retry_interval, Clock::now()), logger_(std::move(log))
{
  check(options_);
  link_.error = {ErrorCode::link_lost, fmt::format("connecting to {}", options_.address)};
}

void StateReceiver::Impl::run(const std::stop_token & stop)
{
  // ur_rtde's threads inherit the priority.
  if (const Status allowed = set_realtime_priority(options_.realtime_priority); !allowed) {
    logger_.log(LogLevel::warn, allowed.error().message);
  }
  while (!stop.stop_requested()) {
    const Outage outage = connect_and_receive(stop);
    set_link({false, outage.error});
    pause(stop, outage.delay);
    if (!stop.stop_requested()) {
      report_outage(outage.error);
    }
  }
}

StateReceiver::Impl::Outage StateReceiver::Impl::connect_and_receive(const std::stop_token & stop)
{
  auto socket = TcpSocket::connect(options_.address, rtde_port, options_.connect_timeout);
  if (!socket) {
    return {socket.error(), retry_.after_refusal(Clock::now())};
  }
  if (const auto connected = connect(std::move(*socket)); !connected) {
    return {connected.error(), retry_.after_failure()};
  }
  report_connection();
  const auto begin = Clock::now();
  Error end = receive_packages(stop);
  loss_ = end;
  return {std::move(end), retry_.after_loss(begin, Clock::now())};
}

void StateReceiver::Impl::report_connection()
{
  if (loss_) {
    logger_.log(LogLevel::warn, fmt::format("{}; connected again", loss_->message));
    loss_.reset();
  }
  logger_.reset();
  logger_.log(LogLevel::info, fmt::format("connected to {}: PolyScope {}, {} Hz", options_.address,
                                          to_string(*version_), frequency_));
}

void StateReceiver::Impl::report_outage(const Error & why)
{
  if (!retry_.worth_reporting(Clock::now())) {
    return;
  }
  const Error & cause = loss_ ? *loss_ : why;
  logger_.log_on_change(LogLevel::error, fmt::format("{}. {}", cause.message, retry_.text()));
  loss_.reset();
}

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

Status StateReceiver::Impl::connect(TcpSocket socket)
{
  const auto version = probe_rtde(std::move(socket), options_.address, options_.connect_timeout);
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

Locked<ur_rtde::RTDEReceiveInterface> StateReceiver::Impl::receive() const
{
  const std::lock_guard lock(mutex_);
  if (!link_.connected || !interface_) {
    throw RobotError(link_.error);
  }
  return {interface_, lock_, "receive interface"};
}

}  // namespace ur_ros_rtde
