#pragma once

#include <functional>
#include <string>
#include <ur_ros_rtde_msgs/msg/teleoperation_state.hpp>

#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"

namespace ur_ros_rtde {

/// What a topic of teleoperation says, in the log and on the topic `teleoperation`. Thread-safe.
class TeleopReports {
 public:
  using State = ur_ros_rtde_msgs::msg::TeleoperationState;
  using Publish = std::function<void(State)>;

  /// `pause`: s without messages, after which teleoperation can start.
  TeleopReports(std::string topic, double pause, LogFunction log, Publish publish);

  void started() const;
  void stopping(const Error & why) const;
  /// `statistics`, of the messages, for the log.
  void ended(const Outcome & outcome, const std::string & statistics) const;
  void ignored(const Error & why) const;
  /// A message that commands no motion is required, because of `why`.
  void hindered(const std::string & why) const;

 private:
  void publish(std::uint8_t state, const Error & why) const;

  const std::string topic_;
  const double pause_;
  const LogFunction log_;
  const Publish publish_;
};

}  // namespace ur_ros_rtde
