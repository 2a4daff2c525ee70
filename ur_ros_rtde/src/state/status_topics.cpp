#include "state/status_topics.hpp"

#include <cmath>
#include <utility>

namespace ur_ros_rtde {
namespace {
/// The newest value if it differs from the published one, which it replaces.
template <typename T>
std::optional<T> take_change(const std::optional<T> & newest, std::optional<T> & published)
{
  return std::exchange(published, newest) != newest ? newest : std::nullopt;
}

/// Differences below a thousandth are not published.
bool differs(double a, double b)
{
  return std::lround(1000.0 * a) != std::lround(1000.0 * b);
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
  update([&sample](Values & newest) {
    newest.robot_mode = sample.robot_mode;
    newest.safety_mode = sample.safety_mode;
    newest.program_running = sample.is_program_running();
    if (!newest.speed_scaling || differs(*newest.speed_scaling, sample.speed_scaling)) {
      newest.speed_scaling = sample.speed_scaling;
    }
  });
}

void StatusTopics::publish_no_controller()
{
  update([](Values & newest) { newest.robot_mode = RobotMode::no_controller; });
}

void StatusTopics::update(const std::function<void(Values &)> & change)
{
  {
    const std::lock_guard lock(mutex_);
    change(newest_);
    if (std::exchange(publishing_, true)) {
      return;
    }
  }
  while (const auto changes = take_changes()) {
    publish(*changes);
  }
}

std::optional<StatusTopics::Values> StatusTopics::take_changes()
{
  const std::lock_guard lock(mutex_);
  Values changes{take_change(newest_.robot_mode, published_.robot_mode),
                 take_change(newest_.safety_mode, published_.safety_mode),
                 take_change(newest_.program_running, published_.program_running),
                 take_change(newest_.speed_scaling, published_.speed_scaling)};
  publishing_ = changes.robot_mode || changes.safety_mode || changes.program_running || changes.speed_scaling;
  return publishing_ ? std::optional(changes) : std::nullopt;
}

void StatusTopics::publish(const Values & values)
{
  if (values.robot_mode) {
    ur_ros_rtde_msgs::msg::RobotMode message;
    message.mode = static_cast<std::int8_t>(*values.robot_mode);
    message.name = to_string(*values.robot_mode);
    robot_mode_->publish(message);
  }
  if (values.safety_mode) {
    ur_ros_rtde_msgs::msg::SafetyMode message;
    message.mode = static_cast<std::uint8_t>(*values.safety_mode);
    message.name = to_string(*values.safety_mode);
    safety_mode_->publish(message);
  }
  if (values.program_running) {
    std_msgs::msg::Bool message;
    message.data = *values.program_running;
    program_running_->publish(message);
  }
  if (values.speed_scaling) {
    std_msgs::msg::Float64 message;
    message.data = *values.speed_scaling;
    speed_scaling_->publish(message);
  }
}

}  // namespace ur_ros_rtde
