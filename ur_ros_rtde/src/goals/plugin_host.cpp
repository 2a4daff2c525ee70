#include "ur_ros_rtde/plugin_host.hpp"

#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

PluginHost::PluginHost(rcl_cxx::Node & node)
    : node_(node),
      // Transient local: a client may be refused before its subscription has been matched.
      refusals_(node.create_publisher<ur_ros_rtde_msgs::msg::GoalRefused>(
          "goal_refusals", rcl_cxx::QoS::transient_local(100))),
      stop_group_(node.create_callback_group())
{
}

void PluginHost::publish_refusal(const std::string & action, const rcl_cxx::GoalUUID & id, const Error & why)
{
  ur_ros_rtde_msgs::msg::GoalRefused refusal;
  refusal.stamp = node_.now();
  refusal.action = action;
  refusal.goal_id.uuid = id.bytes;
  refusal.error_code = static_cast<std::uint16_t>(why.code);
  refusal.message = why.message;
  refusals_->publish(refusal);
}

ArmLimits CommandHost::limits() const
{
  return robot_.limits();
}

}  // namespace ur_ros_rtde
