#pragma once

#include <ur_rtde/rtde_receive_interface.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "connection/retry_delay.hpp"
#include "state/sample_reader.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

class StateReceiver::Impl {
 public:
  /// @throws std::invalid_argument
  Impl(StateReceiverOptions options, LogFunction log);

  void run(const std::stop_token & stop);
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;

  SampleFunction sample_function_;
  LinkFunction link_function_;

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  std::condition_variable_any pause_;
  LinkStatus link_;
  std::optional<ControllerVersion> version_;
  double frequency_ = 0.0;
  Sample latest_{};
  std::shared_ptr<ur_rtde::RTDEReceiveInterface> interface_;

  std::jthread thread_;

 private:
  using Clock = std::chrono::steady_clock;

  /// Why there is no connection, and the delay before the next attempt.
  struct Outage {
    Error error;
    Clock::duration delay;
  };

  Outage connect_and_receive(const std::stop_token & stop);
  Status connect(TcpSocket socket);
  Error receive_packages(const std::stop_token & stop);
  /// Returns when the connection fails or a stop is requested.
  Error monitor(const std::stop_token & stop, ur_rtde::RTDEReceiveInterface & interface);
  Clock::time_point last_activity(ur_rtde::RobotState & state) const;
  void on_package(Sample & sample, const SampleReader & reader);
  void publish(Sample & sample, const SampleReader & reader);
  /// Waits until `timeout`, a stop request, the end of the connection or a failure of sample_function_.
  void pause(const std::stop_token & stop, Clock::duration timeout);
  void set_ended(bool ended);
  void set_failure(const char * what);
  std::optional<std::string> take_failure();
  void set_link(LinkStatus status);
  void report_connection();
  void report_outage(const Error & why);
  double choose_frequency(const ControllerVersion & version);

  const StateReceiverOptions options_;
  std::optional<std::string> failure_;  ///< exception of sample_function_
  bool ended_ = false;                  ///< ur_rtde's thread has ended
  RetryDelay retry_;
  std::optional<Error> loss_;  ///< of the last connection, until it is logged
  std::atomic<bool> processing_ = false;
  std::atomic<Clock::time_point> processed_{};
  ChangeLogger logger_;
  bool frequency_reported_ = false;
  std::shared_ptr<InterfaceLock> lock_ = std::make_shared<InterfaceLock>();
};

}  // namespace ur_ros_rtde
