#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace ur_ros_rtde {

/// Delay before the next attempt to connect. A short outage is ended soon, and a robot that is away for long
/// is not flooded with attempts: while the port refuses connections, the delay is 1 % of the outage so far,
/// at least `shortest` and at most `longest`. That is 100 attempts in the first second, and about 4 per
/// second after 25 s.
class RetryDelay {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds shortest{10};

  /// The outage begins at `now`.
  RetryDelay(std::chrono::milliseconds longest, Clock::time_point now) : longest_(longest), begin_(now) {}

  /// After an attempt without a TCP connection.
  Clock::duration after_refusal(Clock::time_point now) const
  {
    constexpr int part_of_outage = 100;
    return std::clamp<Clock::duration>(outage(now) / part_of_outage, std::min(shortest, longest_), longest_);
  }
  /// After an attempt to which the wrong service, or none, has answered.
  Clock::duration after_failure() const { return longest_; }
  /// After the end of a connection. A connection that has lasted for a while is replaced at once. One that
  /// breaks again and again is replaced at intervals of `longest`.
  Clock::duration after_loss(Clock::time_point connected, Clock::time_point now)
  {
    begin_ = now;
    return now - connected < longest_ ? longest_ : std::chrono::milliseconds(0);
  }

  Clock::duration outage(Clock::time_point now) const { return now - begin_; }
  /// False during the first `longest` of an outage: driver and controller may be shut down together, and a
  /// connection that is replaced soon needs no error message.
  bool worth_reporting(Clock::time_point now) const { return outage(now) >= longest_; }
  /// For the log message about an outage.
  std::string text() const
  {
    return fmt::format("Trying again after at most {} s", std::chrono::duration<double>(longest_).count());
  }

 private:
  std::chrono::milliseconds longest_;
  Clock::time_point begin_;
};

}  // namespace ur_ros_rtde
