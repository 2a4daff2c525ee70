#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"

#include <fmt/format.h>
#include <ur_rtde/dashboard_client.h>

#include <boost/system/system_error.hpp>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "connection/dashboard_request.hpp"
#include "connection/ports.hpp"
#include "connection/retry_delay.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using ur_rtde::DashboardClient;

std::optional<ControllerVersion> parse_version(const std::string & text)
{
  ControllerVersion version;
  const int found = std::sscanf(text.c_str(), "%u.%u.%u.%u", &version.major, &version.minor, &version.bugfix,
                                &version.build);
  return found >= 2 ? std::optional(version) : std::nullopt;
}

/// PolyScope 5.6 introduced "is in remote control". CB3 has no such setting.
bool supports_remote_control(const std::optional<ControllerVersion> & version)
{
  return version && version->major == 5 && version->minor >= 6;
}

}  // namespace

class DashboardConnection::Impl {
 public:
  Impl(DashboardConnectionOptions options, LogFunction log)
      : options_(std::move(options)), retry_(options_.retry_interval, Clock::now()), logger_(std::move(log))
  {
    if (options_.address.empty()) {
      throw std::invalid_argument("the robot's address is empty: give its IP address or host name");
    }
    link_.error = {ErrorCode::link_lost,
                   fmt::format("connecting to the dashboard server at {}", options_.address)};
  }

  void run(const std::stop_token & stop);
  Locked<DashboardClient> dashboard() const;
  Status call(const std::function<void(DashboardClient &)> & function);

  std::function<void(const LinkStatus &)> link_function_;
  mutable std::mutex mutex_;
  LinkStatus link_;
  std::optional<bool> remote_;
  std::optional<ControllerVersion> version_;
  const DashboardConnectionOptions options_;
  std::jthread thread_;

 private:
  using Clock = RetryDelay::Clock;

  /// Why there is no connection, and the delay before the next attempt.
  struct Outage {
    Error error;
    Clock::duration delay;
  };

  Outage connect_and_monitor(const std::stop_token & stop);
  Status connect(TcpSocket socket);
  Status heartbeat();
  /// Returns the reason when the connection is lost, or success if a stop is requested.
  Status monitor(const std::stop_token & stop);
  [[noreturn]] static void throw_protocol_error(const std::string & query, const std::string & answer);
  void set_link(LinkStatus status);
  void report_failure(const std::shared_ptr<DashboardClient> & client, const std::string & why);
  /// Waits until the next heartbeat, a stop request or the loss of the connection.
  void wait_for_heartbeat(const std::stop_token & stop);
  void wait_for_retry(const std::stop_token & stop, Clock::duration delay);

  RetryDelay retry_;
  std::optional<Error> loss_;  ///< of the last connection, until it is logged
  ChangeLogger logger_;
  std::shared_ptr<InterfaceLock> lock_ = std::make_shared<InterfaceLock>();
  std::shared_ptr<DashboardClient> client_;
  bool supports_remote_ = false;
  bool broken_ = false;
  std::condition_variable_any wake_;
};

Status DashboardConnection::Impl::connect(TcpSocket socket)
{
  if (auto status = probe_dashboard(std::move(socket), options_.address, options_.connect_timeout); !status) {
    return status;
  }
  std::shared_ptr<DashboardClient> previous;  // closed without the lock
  try {
    auto client = std::make_shared<DashboardClient>(options_.address, dashboard_port);
    client->connect(static_cast<std::uint32_t>(options_.connect_timeout.count()));
    const auto version = parse_version(client->polyscopeVersion());
    supports_remote_ = supports_remote_control(version);
    std::optional<bool> remote;
    if (supports_remote_) {
      remote = client->isInRemoteControl();
    }
    const std::lock_guard lock(mutex_);
    previous = std::exchange(client_, std::move(client));
    version_ = version;
    remote_ = remote;
    broken_ = false;
    return {};
  } catch (const std::exception & error) {
    return failure(ErrorCode::link_lost,
                   fmt::format("the dashboard server at {}:{} does not follow the protocol: {}",
                               options_.address, dashboard_port, printable(error.what())));
  }
}

Locked<DashboardClient> DashboardConnection::Impl::dashboard() const
{
  const std::lock_guard lock(mutex_);
  if (!link_.connected || !client_) {
    throw RobotError(link_.error);
  }
  return {client_, lock_, "dashboard client"};
}

void DashboardConnection::Impl::report_failure(const std::shared_ptr<DashboardClient> & client,
                                               const std::string & why)
{
  {
    const std::lock_guard lock(mutex_);
    if (client != client_) {
      return;
    }
    broken_ = true;
    link_.error = {ErrorCode::link_lost,
                   fmt::format("lost the dashboard server at {}: {}", options_.address, why)};
  }
  wake_.notify_all();
}

Status DashboardConnection::Impl::call(const std::function<void(DashboardClient &)> & function)
{
  std::shared_ptr<DashboardClient> client;
  {
    const std::lock_guard lock(mutex_);
    if (!link_.connected || broken_ || !client_) {
      return tl::unexpected(link_.error);
    }
    client = client_;
  }
  try {
    const auto held = Locked(client, lock_, "dashboard client").hold();
    function(*held);
    return {};
  } catch (const RobotError & error) {
    return tl::unexpected(error.error());
  } catch (const boost::system::system_error & error) {
    report_failure(client, error.what());
    return failure(ErrorCode::link_lost, fmt::format("the dashboard server at {} did not answer: {}",
                                                     options_.address, error.what()));
  } catch (const std::exception & error) {
    if (!client->isConnected()) {
      report_failure(client, error.what());
    }
    return failure(ErrorCode::rejected_by_robot,
                   fmt::format("the robot answered: {}", printable(error.what())));
  }
}

/// The answer belongs to another query, so that the following answers would be wrong, too.
[[noreturn]] void DashboardConnection::Impl::throw_protocol_error(const std::string & query,
                                                                  const std::string & answer)
{
  throw boost::system::system_error(make_error_code(boost::system::errc::protocol_error),
                                    fmt::format("\"{}\" was answered \"{}\"", query, printable(answer)));
}

Status DashboardConnection::Impl::heartbeat()
{
  std::optional<bool> remote;
  const auto status = call([&](DashboardClient & client) {
    const std::string query = supports_remote_ ? "is in remote control" : "running";
    client.send(query + "\n");
    const std::string answer = client.receive();
    const bool yes = answer.find("true") != std::string::npos;
    if (!yes && answer.find("false") == std::string::npos) {
      throw_protocol_error(query, answer);
    }
    if (supports_remote_) {
      remote = yes;
    }
  });
  if (status) {
    const std::lock_guard lock(mutex_);
    remote_ = remote;
  } else if (status.error().code == ErrorCode::busy) {
    return {};  // another thread's call is running and will detect a lost connection
  }
  return status;
}

void DashboardConnection::Impl::set_link(LinkStatus status)
{
  bool changed = false;
  std::shared_ptr<DashboardClient> dropped;  // closed without the lock
  {
    const std::lock_guard lock(mutex_);
    changed = link_.connected != status.connected || link_.error.message != status.error.message;
    link_ = status;
    if (!status.connected) {
      dropped = std::exchange(client_, nullptr);
      remote_.reset();
    }
  }
  if (changed && link_function_) {
    link_function_(status);
  }
}

void DashboardConnection::Impl::wait_for_heartbeat(const std::stop_token & stop)
{
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, stop, options_.heartbeat, [this] { return broken_; });
}

void DashboardConnection::Impl::wait_for_retry(const std::stop_token & stop, Clock::duration delay)
{
  std::unique_lock lock(mutex_);
  broken_ = false;
  wake_.wait_for(lock, stop, delay, [this] { return broken_; });
}

Status DashboardConnection::Impl::monitor(const std::stop_token & stop)
{
  Status alive;
  while (alive && !stop.stop_requested()) {
    wait_for_heartbeat(stop);
    if (!stop.stop_requested()) {
      alive = heartbeat();
    }
  }
  return alive;
}

void DashboardConnection::Impl::run(const std::stop_token & stop)
{
  while (!stop.stop_requested()) {
    const Outage outage = connect_and_monitor(stop);
    if (outage.delay > Clock::duration::zero() && !stop.stop_requested()) {
      set_link({false, outage.error});
      wait_for_retry(stop, outage.delay);
    }
    if (!stop.stop_requested() && retry_.worth_reporting(Clock::now())) {
      logger_.log_on_change(LogLevel::error, fmt::format("{}. {}", outage.error.message, retry_.text()));
      loss_.reset();
    }
  }
}

DashboardConnection::Impl::Outage DashboardConnection::Impl::connect_and_monitor(const std::stop_token & stop)
{
  auto socket = TcpSocket::connect(options_.address, dashboard_port, options_.connect_timeout);
  if (!socket) {
    return {socket.error(), retry_.after_refusal(Clock::now())};
  }
  if (const auto connected = connect(std::move(*socket)); !connected) {
    return {connected.error(), retry_.after_failure()};
  }
  if (loss_) {
    logger_.log(LogLevel::warn, fmt::format("{}; connected again", loss_->message));
  }
  logger_.reset();
  set_link({true, {}});
  const auto begin = Clock::now();
  const Status end = monitor(stop);
  loss_ = end ? std::nullopt : std::optional(end.error());
  return {end ? Error{} : end.error(), retry_.after_loss(begin, Clock::now())};
}

DashboardConnection::DashboardConnection(DashboardConnectionOptions options, LogFunction log)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(log)))
{
}

DashboardConnection::~DashboardConnection()
{
  stop();
}

void DashboardConnection::on_link(std::function<void(const LinkStatus &)> function)
{
  impl_->link_function_ = std::move(function);
}

void DashboardConnection::start()
{
  if (!impl_->thread_.joinable()) {
    impl_->thread_ = std::jthread([impl = impl_.get()](const std::stop_token & stop) { impl->run(stop); });
  }
}

void DashboardConnection::stop()
{
  if (impl_->thread_.joinable()) {
    impl_->thread_.request_stop();
    impl_->thread_.join();
  }
}

LinkStatus DashboardConnection::link() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->link_;
}

std::optional<bool> DashboardConnection::in_remote_control() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->remote_;
}

std::optional<ControllerVersion> DashboardConnection::version() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->version_;
}

Locked<DashboardClient> DashboardConnection::dashboard() const
{
  return impl_->dashboard();
}

Status DashboardConnection::call(const std::function<void(DashboardClient &)> & function)
{
  return impl_->call(function);
}

Expected<std::string> DashboardConnection::request(const std::string & line,
                                                   std::chrono::milliseconds timeout,
                                                   const std::stop_token & stop) const
{
  return dashboard_request(impl_->options_.address, line, timeout, stop);
}

const std::string & DashboardConnection::address() const
{
  return impl_->options_.address;
}

}  // namespace ur_ros_rtde
