#pragma once

#include <chrono>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

#include "nodes/robot_state_receiver.hpp"
#include "teleoperation/options.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// Parameters are read once, at the start, and read-only from then on. These functions declare and check
/// them; they throw rcl_cxx::ParameterError with name, value and what it may be.

std::string declare_robot_ip(rcl_cxx::Node & node);

/// After which silence of the controller the link counts as lost.
std::chrono::milliseconds declare_silence_limit(rcl_cxx::Node & node);

/// SCHED_FIFO of the threads on which a control cycle waits; 0: none.
int declare_realtime_priority(rcl_cxx::Node & node);

struct PluginChoice {
  std::vector<std::string> plugins;
  std::vector<std::string> blacklist;
};
PluginChoice declare_plugin_choice(rcl_cxx::Node & node);

/// tf_prefix, qos, rtde_frequency, robot_state_fields, publish_tf
RobotStateReceiver::Options declare_state_options(rcl_cxx::Node & node);

struct CommandServerParameters {
  RobotOptions robot;
  CommandHost::Options goals;
  TeleoperationOptions teleoperation;
};
CommandServerParameters declare_command_server(rcl_cxx::Node & node);

}  // namespace ur_ros_rtde
