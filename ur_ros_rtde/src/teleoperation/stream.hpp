#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "teleoperation/follower.hpp"
#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// One topic by which the arm is moved, with a thread of its own. A stream begins with the first message
/// after a pause of `timeout`, takes the arm for itself (Resource::motion; refused when somebody else has it)
/// and ends when no message comes for `timeout`, with one that is refused, when another goal takes over, and
/// when the robot stops. Then the arm decelerates to standstill, and what still comes moves nothing until
/// there has been a pause. Each beginning and each end is logged once.
class Stream {
 public:
  /// `topic` as users know it: "/servo_joint". `host` outlives this.
  Stream(std::string topic, CommandHost & host, const TeleoperationOptions & options,
         std::unique_ptr<Follower> follower, LogFunction log);
  /// Ends the stream and joins the thread.
  ~Stream();
  Stream(const Stream &) = delete;
  Stream & operator=(const Stream &) = delete;

  /// A message: its target, or why it is none. Does not wait.
  void put(Expected<StreamTarget> target);
  /// The stream ends, if there is one, and no other begins.
  void close();

 private:
  using Clock = std::chrono::steady_clock;

  struct Message {
    Expected<StreamTarget> target = StreamTarget{};
    Clock::time_point arrived{};
    std::uint64_t number = 0;
    std::uint64_t burst = 0;  ///< messages without a pause between them
    double period = 0.0;      ///< s from message to message, smoothed
  };

  /// How long messages waited for their command.
  struct Latency {
    void add(Clock::duration wait);
    std::string text() const;
    std::uint64_t count = 0;
    Clock::duration sum{}, longest{};
  };

  void serve(const std::stop_token & stop);
  Outcome live(std::uint64_t burst, Latency & latency);
  /// Message by message and package by package, until there is a reason to end.
  Error follow(Run & run, std::uint64_t burst, Latency & latency);
  Status in_time(const Message & message, std::uint64_t burst) const;
  Status aim(const Message & message, std::uint64_t burst) const;
  /// Why the stream ends, and whether the arm stands still after it.
  Outcome stop(const Error & why) const;
  Message newest() const;
  void log_end(const Outcome & outcome, const Latency & latency) const;

  const std::string topic_;
  CommandHost & host_;
  const TeleoperationOptions options_;
  const std::unique_ptr<Follower> follower_;
  const LogFunction log_;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Message newest_;
  std::shared_ptr<StopRequest> stop_request_;  ///< of the stream that lives
  bool closed_ = false;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
