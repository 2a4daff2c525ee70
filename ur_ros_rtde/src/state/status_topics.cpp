#include "state/status_topics.hpp"

#include <cmath>
#include <utility>

namespace ur_ros_rtde {
namespace {
/// Stores `value` as published. Returns whether it differs from the value published before.
template <typename T>
bool update(std::optional<T> & published, const T & value)
{
  return std::exchange(published, value) != value;
}
}  // namespace

StatusTopics::StatusTopics(rcl_cxx::Node & node)
    : robot_mode_(node.create_publisher<ur_ros_rtde_msgs::msg::RobotMode>("robot_mode",
                                                                          rcl_cxx::QoS::transient_local())),
      safety_mode_(node.create_publisher<ur_ros_rtde_msgs::msg::SafetyMode>("safety_mode",
                                                                            rcl_cxx::QoS::transient_local())),
      program_running_(
          node.create_publisher<std_msgs::msg::Bool>("program_running", rcl_cxx::QoS::transient_local())),
      speed_scaling_(
          node.create_publisher<std_msgs::msg::Float64>("speed_scaling", rcl_cxx::QoS::transient_local()))
{
  publish_no_controller();
}

void StatusTopics::publish(const Sample & sample)
{
  const std::lock_guard lock(mutex_);
  if (update(published_robot_mode_, sample.robot_mode)) {
    publish(sample.robot_mode);
  }
  if (update(published_safety_mode_, sample.safety_mode)) {
    publish(sample.safety_mode);
  }
  if (update(published_program_running_, sample.program_running())) {
    std_msgs::msg::Bool message;
    message.data = sample.program_running();
    program_running_->publish(message);
  }
  if (update(published_speed_scaling_, std::lround(1000.0 * sample.speed_scaling))) {
    std_msgs::msg::Float64 message;
    message.data = sample.speed_scaling;
    speed_scaling_->publish(message);
  }
}

void StatusTopics::publish_no_controller()
{
  const std::lock_guard lock(mutex_);
  if (update(published_robot_mode_, RobotMode::no_controller)) {
    publish(RobotMode::no_controller);
  }
}

void StatusTopics::publish(RobotMode mode)
{
  ur_ros_rtde_msgs::msg::RobotMode message;
  message.mode = static_cast<std::int8_t>(mode);
  message.name = to_string(mode);
  robot_mode_->publish(message);
}

void StatusTopics::publish(SafetyMode mode)
{
  ur_ros_rtde_msgs::msg::SafetyMode message;
  message.mode = static_cast<std::uint8_t>(mode);
  message.name = to_string(mode);
  safety_mode_->publish(message);
}

}  // namespace ur_ros_rtde
