#include "nodes/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {
namespace {
rcl_cxx::ParameterDescriptor described(std::string description)
{
  rcl_cxx::ParameterDescriptor options;
  options.description = std::move(description);
  options.read_only = true;
  return options;
}

double declare_number(rcl_cxx::Node & node, const std::string & name, double value, double low, double high,
                      std::string description)
{
  auto options = described(std::move(description));
  options.floating_point_range = rcl_cxx::FloatingPointRange{low, high};
  return node.declare_parameter(name, value, options);
}

std::string declare_choice(rcl_cxx::Node & node, const std::string & name, const std::string & value,
                           const std::vector<std::string> & choices, std::string description)
{
  auto options = described(std::move(description));
  options.additional_constraints = fmt::format("one of: {}", fmt::join(choices, ", "));
  const auto chosen = node.declare_parameter(name, value, options);
  if (std::find(choices.begin(), choices.end(), chosen) == choices.end()) {
    throw rcl_cxx::ParameterError(
        name, fmt::format("parameter {} is \"{}\", it may be {}", name, chosen, fmt::join(choices, ", ")));
  }
  return chosen;
}

/// Part of a name: letters, digits, '_' and '/', the latter as the official driver's prefixes may have it.
std::string declare_tf_prefix(rcl_cxx::Node & node)
{
  auto options = described(
      "Put before the names of joints and frames, as in the URDF: \"left_\" makes "
      "left_shoulder_pan_joint, left_base, left_tool0_controller");
  options.additional_constraints = "letters, digits, '_' and '/'";
  const auto prefix = node.declare_parameter("tf_prefix", "", options);
  const auto wrong = std::find_if(prefix.begin(), prefix.end(), [](unsigned char c) {
    return std::isalnum(c) == 0 && c != '_' && c != '/';
  });
  if (wrong != prefix.end()) {
    throw rcl_cxx::ParameterError(
        "tf_prefix",
        fmt::format("parameter tf_prefix is \"{}\", it may have letters, digits, '_' and '/'", prefix));
  }
  return prefix;
}

std::vector<std::string> declare_robot_state_fields(rcl_cxx::Node & node)
{
  auto options = described("RTDE outputs to publish on robot_state, by name; none: no such topic");
  options.additional_constraints =
      "names of the table \"Robot controller outputs\" in UR's \"Real-Time Data Exchange (RTDE) Guide\"";
  const auto fields = node.declare_parameter("robot_state_fields", std::vector<std::string>{}, options);
  if (const Status known = check_rtde_outputs(fields); !known) {
    throw rcl_cxx::ParameterError("robot_state_fields",
                                  "parameter robot_state_fields: " + known.error().message);
  }
  return fields;
}

std::string declare_model(rcl_cxx::Node & node)
{
  auto options = described(
      "Model of the arm, for the speed limits of its joints and its reach. A wrong one keeps the arm from "
      "being moved. Empty: as the controller says");
  options.additional_constraints = fmt::format("empty, or one of: {}", arm_models());
  const auto model = node.declare_parameter("ur_type", "", options);
  if (model.empty() || arm_limits(model)) {
    return model;
  }
  throw rcl_cxx::ParameterError(
      "ur_type",
      fmt::format("parameter ur_type is \"{}\", and there is no such model: {}, or empty for the one "
                  "that the controller tells",
                  model, arm_models()));
}

TeleoperationOptions declare_teleoperation(rcl_cxx::Node & node)
{
  TeleoperationOptions options;
  options.timeout =
      declare_number(node, "stream_timeout", options.timeout, 0.02, 1.0,
                     "s: a stream of servo_joint, servo_pose or twist ends, and the arm decelerates, when no "
                     "message has come for so long; the next one begins after such a pause");
  options.max_joint_jump = declare_number(node, "stream_max_joint_jump", options.max_joint_jump, 0.001, 1.0,
                                          "rad: how far a target of a stream may be from where the arm is "
                                          "sent, a joint or the rotation of a pose");
  options.max_linear_jump =
      declare_number(node, "stream_max_linear_jump", options.max_linear_jump, 0.001, 1.0,
                     "m: how far a pose of a stream may be from where the TCP is sent");
  options.acceleration = declare_number(node, "stream_acceleration", options.acceleration, 0.01, 150.0,
                                        "m/s^2: with which the TCP gets to the velocity of a twist");
  options.deceleration = declare_number(node, "stream_deceleration", options.deceleration, 0.1, 40.0,
                                        "rad/s^2 and m/s^2: of the stop at the end of a stream");
  options.lookahead_time =
      declare_number(node, "stream_lookahead_time", options.lookahead_time, 0.03, 0.2,
                     "s: how far ahead the controller smooths servo_joint and servo_pose; small is stiff");
  options.gain = declare_number(node, "stream_gain", options.gain, 100.0, 2000.0,
                                "of the controller's position control in servo_joint and servo_pose");
  return options;
}
}  // namespace

std::string declare_robot_ip(rcl_cxx::Node & node)
{
  const auto address =
      node.declare_parameter("robot_ip", "", described("Address or host name of the robot's controller"));
  if (address.empty()) {
    throw rcl_cxx::ParameterError(
        "robot_ip",
        "parameter robot_ip is not set: give the address of the robot's controller, for example with "
        "--ros-args -p robot_ip:=192.168.0.10");
  }
  return address;
}

std::chrono::milliseconds declare_silence_limit(rcl_cxx::Node & node)
{
  const double seconds = declare_number(
      node, "silence_limit", 0.1, 0.02, 10.0,
      "s: the link counts as lost, and a motion ends, when the controller has sent nothing for so long");
  return std::chrono::milliseconds(std::lround(1000.0 * seconds));
}

int declare_realtime_priority(rcl_cxx::Node & node)
{
  auto options = described(
      "SCHED_FIFO priority of the threads that take the robot's packages and answer them with targets; 0: "
      "the "
      "priority of all other threads");
  options.integer_range = rcl_cxx::IntegerRange{0, 99};
  return static_cast<int>(node.declare_parameter<int>("realtime_priority", 0, options));
}

PluginChoice declare_plugin_choice(rcl_cxx::Node & node)
{
  const std::vector<std::string> none;
  return {node.declare_parameter(
              "plugins", none,
              described("Names of the plugins to load, which are those of their actions; empty: all found")),
          node.declare_parameter("plugins_blacklist", none, described("Names of plugins not to load"))};
}

RobotStateReceiver::Options declare_state_options(rcl_cxx::Node & node)
{
  RobotStateReceiver::Options options;
  options.tf_prefix = declare_tf_prefix(node);
  options.qos = declare_choice(node, "qos", "reliable", rcl_cxx::QoS::names(),
                               "Quality of service of the published state, by name");
  options.frequency = declare_number(node, "rtde_frequency", 500.0, 1.0, 500.0,
                                     "Hz, of the published state; a CB3 controller gives at most 125");
  options.fields = declare_robot_state_fields(node);
  options.publish_tf = node.declare_parameter(
      "publish_tf", true,
      described("Broadcast the transform base -> tool0_controller, the TCP pose, on /tf"));
  return options;
}

CommandServerParameters declare_command_server(rcl_cxx::Node & node)
{
  CommandServerParameters parameters;
  RobotOptions & robot = parameters.robot;
  robot.address = declare_robot_ip(node);
  robot.control_mode =
      declare_choice(node, "control_mode", "upload", {"upload", "control_urcap"},
                     "Where the control program comes from: sent to the robot (an e-Series robot must be in "
                     "remote control), or fetched by the External Control URCap") == "upload"
          ? ControlMode::upload
          : ControlMode::control_urcap;
  auto port = described("Port at which the External Control URCap finds this node");
  port.integer_range = rcl_cxx::IntegerRange{1, 65535};
  robot.urcap_port = static_cast<std::uint16_t>(node.declare_parameter<int>("urcap_port", 50002, port));
  robot.silence_limit = declare_silence_limit(node);
  robot.realtime_priority = declare_realtime_priority(node);
  robot.watchdog_frequency = declare_number(
      node, "watchdog_frequency", robot.watchdog_frequency, 0.0, max_watchdog_frequency,
      "Hz: the robot stops the arm after 1/watchdog_frequency s without a sign of life of this "
      "node; 0: no watchdog");
  robot.restart_program = node.declare_parameter(
      "restart_program", true,
      described("Start the control program again after it was stopped, never what it was "
                "doing"));
  parameters.goals.preempt_when_busy =
      declare_choice(node, "on_busy", "refuse", {"refuse", "preempt"},
                     "What happens to a motion that comes while another runs: it is refused, or the other is "
                     "stopped for it") == "preempt";
  parameters.goals.stop_when_client_lost =
      declare_choice(node, "on_client_lost", "stop", {"stop", "continue"},
                     "What happens to a goal whose client has disappeared: the arm decelerates to a "
                     "standstill and the goal ends with CLIENT_LOST, or the goal goes on") == "stop";
  robot.model = declare_model(node);
  robot.upper_range_registers =
      declare_choice(node, "register_range", "lower", {"lower", "upper"},
                     "Which general purpose registers of the robot the driver uses: 0 to 23, or 24 to 47, "
                     "beside a fieldbus (EtherNet/IP, PROFINET, MODBUS), which has the lower ones") ==
      "upper";
  parameters.teleoperation = declare_teleoperation(node);
  return parameters;
}

}  // namespace ur_ros_rtde
