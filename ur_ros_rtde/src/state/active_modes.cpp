#include "state/active_modes.hpp"

namespace ur_ros_rtde {
namespace {
constexpr std::chrono::milliseconds period{100};
}  // namespace

std::vector<std::string> mode_names(Activities activities)
{
  std::vector<std::string> names;
  const auto add = [&](Activity activity, const char * name) {
    if (activities.contains(activity)) {
      names.emplace_back(name);
    }
  };
  add(Activity::force_mode, "force_mode");
  add(Activity::freedrive, "freedrive");
  add(Activity::teach_mode, "teach_mode");
  return names;
}

ActiveModesTopic::ActiveModesTopic(rcl_cxx::Node & node, const Robot & robot)
    : node_(node),
      robot_(robot),
      publisher_(node.create_publisher<ur_ros_rtde_msgs::msg::ActiveModes>("active_modes",
                                                                           rcl_cxx::QoS::transient_local()))
{
  publish({});
  timer_ = node.create_wall_timer(period, [this] {
    if (const Activities active = robot_.activities() & outlasting_modes; active != published_) {
      publish(active);
    }
  });
}

void ActiveModesTopic::publish(Activities active)
{
  published_ = active;
  ur_ros_rtde_msgs::msg::ActiveModes message;
  message.stamp = node_.now();
  message.names = mode_names(active);
  publisher_->publish(message);
}

}  // namespace ur_ros_rtde
