#pragma once

#include <functional>
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
/// late subscribers receive the last value. Thread-safe: if several threads publish at the same time, one of
/// them publishes the newest values of all, so that the last message is the newest value.
class StatusTopics {
 public:
  explicit StatusTopics(rcl_cxx::Node & node);

  void publish(const Sample & sample);
  /// Publishes that there is no controller on robot_mode. The other topics keep their last value.
  void publish_no_controller();

 private:
  struct Values {
    std::optional<RobotMode> robot_mode;
    std::optional<SafetyMode> safety_mode;
    std::optional<bool> program_running;
    std::optional<double> speed_scaling;
  };

  void update(const std::function<void(Values &)> & change);
  /// The values that differ from the published ones; none if all are published.
  std::optional<Values> take_changes();
  void publish(const Values & values);

  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::RobotMode>::SharedPtr robot_mode_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::SafetyMode>::SharedPtr safety_mode_;
  rcl_cxx::Publisher<std_msgs::msg::Bool>::SharedPtr program_running_;
  rcl_cxx::Publisher<std_msgs::msg::Float64>::SharedPtr speed_scaling_;

  std::mutex mutex_;
  Values newest_;
  Values published_;
  bool publishing_ = false;  ///< by one of the threads
};

}  // namespace ur_ros_rtde
