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

/// robot_mode, safety_mode, program_running, speed_scaling: published when they change; who comes later gets
/// the last. Thread-safe.
class LatchedState {
 public:
  explicit LatchedState(rcl_cxx::Node & node);

  void publish(const Sample & sample);
  /// There is no controller any more, or not yet: robot_mode says so, the others say what was last.
  void publish_no_controller();

 private:
  void publish(RobotMode mode);
  void publish(SafetyMode mode);

  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::RobotMode>::SharedPtr robot_mode_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::SafetyMode>::SharedPtr safety_mode_;
  rcl_cxx::Publisher<std_msgs::msg::Bool>::SharedPtr program_running_;
  rcl_cxx::Publisher<std_msgs::msg::Float64>::SharedPtr speed_scaling_;

  std::mutex mutex_;
  std::optional<RobotMode> robot_mode_shown_;
  std::optional<SafetyMode> safety_mode_shown_;
  std::optional<bool> program_running_shown_;
  std::optional<long> speed_scaling_shown_;  ///< thousandths: a change that is less is none
};

}  // namespace ur_ros_rtde
