#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_rtde {
class RTDEReceiveInterface;
}

namespace ur_ros_rtde {

struct StateReceiverOptions {
  std::string address;
  /// Hz, 1 to 500; 0: the controller's maximum. A rate above the maximum (CB3: 125) is reduced to it with a
  /// warning.
  double frequency = 0.0;
  /// Timeout of each step of connecting. A controller answers within milliseconds.
  std::chrono::milliseconds connect_timeout{500};
  /// Longest delay between connection attempts. A lost connection is replaced at once. While the controller
  /// refuses connections, the delay is 1 % of the outage so far, at least 10 ms.
  std::chrono::milliseconds retry_interval{250};
  /// Time without a package after which the connection counts as lost although the socket is open; at rates
  /// below 50 Hz, five periods instead.
  std::chrono::milliseconds silence_limit{100};
  /// Read the general purpose registers 24-47 instead of 0-23.
  bool upper_range_registers = false;
  /// SCHED_FIFO priority of the receiving thread, 1 to 99; 0: none. Logs a warning if not permitted.
  int realtime_priority = 0;
};

/// Receives the RTDE packages of a controller. Connects in the background as soon as there is a controller at
/// the address, and again after reboots, until this object is destroyed. Any number of receivers may use one
/// controller. All methods are thread-safe.
class StateReceiver {
 public:
  using SampleFunction = std::function<void(const Sample &)>;
  using LinkFunction = std::function<void(const LinkStatus &)>;

  /// Throws std::invalid_argument for an empty address or an option out of range. Network problems do not
  /// throw.
  explicit StateReceiver(StateReceiverOptions options, LogFunction log = {});
  /// Calls stop().
  ~StateReceiver();
  StateReceiver(const StateReceiver &) = delete;
  StateReceiver & operator=(const StateReceiver &) = delete;

  /// Called with each package, in order, on the receiving thread; must return quickly. Never runs
  /// concurrently with the function of on_link(). If it throws, the connection is closed and re-established.
  /// Set before start().
  void on_sample(SampleFunction function);
  /// Called on a thread of the receiver when the connection is established or lost. Must not throw. Set
  /// before start().
  void on_link(LinkFunction function);
  void start();
  /// Joins all threads; no callback runs afterwards. Takes at most as long as one connection attempt.
  void stop();

  LinkStatus link() const;
  /// Version of the last connected controller.
  std::optional<ControllerVersion> version() const;
  /// Hz, as agreed with the controller; 0 before the first connection.
  double frequency() const;

  /// The newest sample, even if the connection has been lost; none before the first.
  std::optional<Sample> latest() const;
  /// Waits for a sample newer than `last` (by its sequence) and writes it to `last`. False after `timeout` or
  /// if a stop is requested.
  bool wait_for_next(Sample & last, std::chrono::milliseconds timeout, std::stop_token stop = {}) const;

  /// ur_rtde's interface, for data that a Sample does not contain. Throws RobotError (link_lost) without a
  /// connection.
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
