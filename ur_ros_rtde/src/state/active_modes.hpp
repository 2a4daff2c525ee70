#pragma once

#include <rcl_cxx/node.hpp>
#include <string>
#include <ur_ros_rtde_msgs/msg/active_modes.hpp>
#include <vector>

#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// "force_mode", "freedrive", "teach_mode": those of `activities` that may outlast their goal.
std::vector<std::string> mode_names(Activities activities);

/// Publishes active_modes on each change. Transient local: late subscribers receive the last value.
class ActiveModesTopic {
 public:
  ActiveModesTopic(rcl_cxx::Node & node, const Robot & robot);

 private:
  void publish(Activities active);

  rcl_cxx::Node & node_;
  const Robot & robot_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::ActiveModes>::SharedPtr publisher_;
  Activities published_;
  std::shared_ptr<rcl_cxx::Timer> timer_;
};

}  // namespace ur_ros_rtde
