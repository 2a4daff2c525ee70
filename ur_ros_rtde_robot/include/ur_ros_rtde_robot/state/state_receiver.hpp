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
  /// Hz, 1 to 500; more than the controller can (CB3: 125) is reduced to that with a message. 0: what the
  /// controller can.
  double frequency = 0.0;
  /// For one step of connecting. A controller answers in milliseconds.
  std::chrono::milliseconds connect_timeout{500};
  /// From one failed try to the next.
  std::chrono::milliseconds retry_interval{250};
  /// Silence after which the link counts as lost though the socket is open; at rates below 50 Hz, five
  /// periods instead.
  std::chrono::milliseconds silence_limit{100};
  bool upper_range_registers = false;
  /// SCHED_FIFO, 1 to 99, of the thread that follows the packages; 0: none. Said in the log when not allowed.
  int realtime_priority = 0;
};

/// Follows a controller's RTDE packages, connecting in the background whenever there is a controller at the
/// address: before it is there, through its reboots, until this object is destroyed. Any number of receivers
/// may follow one controller. All methods are thread-safe.
class StateReceiver {
 public:
  using SampleFunction = std::function<void(const Sample &)>;
  using LinkFunction = std::function<void(const LinkStatus &)>;

  /// Throws std::invalid_argument for an empty address or a frequency outside 1-500 Hz (0 excepted); never
  /// for the network's sake.
  explicit StateReceiver(StateReceiverOptions options, LogFunction log = {});
  /// Ends the thread; takes as long as a step of connecting at most.
  ~StateReceiver();
  StateReceiver(const StateReceiver &) = delete;
  StateReceiver & operator=(const StateReceiver &) = delete;

  /// Called with every package on the thread that has received it, in order, and never at the same time as
  /// on_link's function: be brief. What it throws ends the link, which is then made anew. Set before start().
  void on_sample(SampleFunction function);
  /// Called on a thread of the receiver when the link comes or goes. Set before start().
  void on_link(LinkFunction function);
  void start();
  /// Ends the thread and with it all callbacks; takes as long as a step of connecting at most. The destructor
  /// does it, too.
  void stop();

  LinkStatus link() const;
  /// Of the controller last connected to.
  std::optional<ControllerVersion> version() const;
  /// Hz agreed with the controller; 0 before the first connection.
  double frequency() const;

  /// The newest sample, whether or not the link still stands; none before the first.
  std::optional<Sample> latest() const;
  /// Waits for a sample newer than `last` (by its sequence) and writes it there. False after `limit`, or when
  /// stop is requested.
  bool wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop = {}) const;

  /// ur_rtde's own interface, for what a Sample does not hold. Throws RobotError (link_lost) without a
  /// connection.
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
