#pragma once

#include <chrono>
#include <rcl_cxx/node.hpp>
#include <string>
#include <vector>

#include "nodes/robot_state_receiver.hpp"
#include "ur_ros_rtde/plugin_host.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde_robot/robot_options.hpp"

namespace ur_ros_rtde {

/// Functions that declare and check parameters. Parameters are read at the start and are read-only
/// afterwards. The functions throw rcl_cxx::ParameterError with the name, the value and the allowed values.

std::string declare_robot_ip(rcl_cxx::Node & node);

/// Time without data after which the connection to the controller is considered lost.
std::chrono::milliseconds declare_silence_limit(rcl_cxx::Node & node);

/// SCHED_FIFO priority of the threads that run once per control cycle. 0: no real-time scheduling.
int declare_realtime_priority(rcl_cxx::Node & node);

struct PluginChoice {
  std::vector<std::string> plugins;
  std::vector<std::string> blacklist;
};
PluginChoice declare_plugin_choice(rcl_cxx::Node & node);

/// Whether the endpoints of an action are created for its first client: the parameter servers.
bool declare_servers_on_demand(rcl_cxx::Node & node);

/// tf_prefix, qos, rtde_frequency, robot_state_fields, publish_tf
RobotStateReceiver::Options declare_state_options(rcl_cxx::Node & node);

struct CommandServerParameters {
  std::string tf_prefix;
  RobotOptions robot;
  CommandHost::Options goals;
  StreamOptions teleoperation;
};
CommandServerParameters declare_command_server(rcl_cxx::Node & node);

}  // namespace ur_ros_rtde
