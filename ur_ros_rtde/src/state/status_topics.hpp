#pragma once

#include <mutex>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/float64.hpp>
#include <ur_ros_rtde_msgs/msg/robot_mode.hpp>
#include <ur_ros_rtde_msgs/msg/safety_mode.hpp>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// Publishes robot_mode, safety_mode, program_running and speed_scaling when they change. Transient local:
/// late subscribers receive the last value. Thread-safe.
class StatusTopics {
 public:
  explicit StatusTopics(rcl_cxx::Node & node);

  void publish(const Sample & sample);
  /// Publishes that there is no controller on robot_mode. The other topics keep their last value.
  void publish_no_controller();

 private:
  void publish(RobotMode mode);
  void publish(SafetyMode mode);

  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::RobotMode>::SharedPtr robot_mode_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::SafetyMode>::SharedPtr safety_mode_;
  rcl_cxx::Publisher<std_msgs::msg::Bool>::SharedPtr program_running_;
  rcl_cxx::Publisher<std_msgs::msg::Float64>::SharedPtr speed_scaling_;

  std::mutex mutex_;
  std::optional<RobotMode> published_robot_mode_;
  std::optional<SafetyMode> published_safety_mode_;
  std::optional<bool> published_program_running_;
  std::optional<long> published_speed_scaling_;  ///< thousandths; smaller changes are ignored
};

}  // namespace ur_ros_rtde
