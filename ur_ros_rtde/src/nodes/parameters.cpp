#include "nodes/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "plugins/similar_names.hpp"
#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"

namespace ur_ros_rtde {
namespace {
rcl_cxx::ParameterDescriptor read_only_descriptor(std::string description)
{
  rcl_cxx::ParameterDescriptor options;
  options.description = std::move(description);
  options.read_only = true;
  return options;
}

double declare_number(rcl_cxx::Node & node, const std::string & name, double value, double low, double high,
                      std::string description)
{
  auto options = read_only_descriptor(std::move(description));
  options.floating_point_range = rcl_cxx::FloatingPointRange{low, high};
  return node.declare_parameter(name, value, options);
}

std::string declare_choice(rcl_cxx::Node & node, const std::string & name, const std::string & value,
                           const std::vector<std::string> & choices, std::string description)
{
  auto options = read_only_descriptor(std::move(description));
  options.additional_constraints = fmt::format("one of: {}", fmt::join(choices, ", "));
  const auto chosen = node.declare_parameter(name, value, options);
  if (std::find(choices.begin(), choices.end(), chosen) == choices.end()) {
    throw rcl_cxx::ParameterError(name, fmt::format("parameter {} is \"{}\", it must be one of {}", name,
                                                    chosen, fmt::join(choices, ", ")));
  }
  return chosen;
}

/// Letters, digits, '_', and '/' as in prefixes of the official driver.
std::string declare_tf_prefix(rcl_cxx::Node & node)
{
  auto options = read_only_descriptor(
      "Prefix of the names of joints and frames, as in the URDF: \"left_\" results in "
      "left_shoulder_pan_joint, left_base, left_tool0_controller");
  options.additional_constraints = "letters, digits, '_' and '/'";
  const auto prefix = node.declare_parameter("tf_prefix", "", options);
  const auto wrong = std::find_if(prefix.begin(), prefix.end(), [](unsigned char c) {
    return std::isalnum(c) == 0 && c != '_' && c != '/';
  });
  if (wrong != prefix.end()) {
    throw rcl_cxx::ParameterError(
        "tf_prefix",
        fmt::format("parameter tf_prefix is \"{}\", it may contain letters, digits, '_' and '/'", prefix));
  }
  return prefix;
}

std::vector<std::string> declare_robot_state_fields(rcl_cxx::Node & node)
{
  auto options = read_only_descriptor(
      "Names of RTDE outputs to publish on robot_state. Empty: the topic is not created");
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
  auto options = read_only_descriptor(
      "Model of the arm, which determines joint speed limits and reach. If it contradicts the controller, "
      "motions are rejected. Empty: as reported by the controller");
  options.additional_constraints = fmt::format("empty, or one of: {}", arm_models());
  const auto model = node.declare_parameter("ur_type", "", options);
  if (model.empty() || arm_limits(model)) {
    return model;
  }
  throw rcl_cxx::ParameterError(
      "ur_type", fmt::format("parameter ur_type is \"{}\", it must be one of {}, or empty to use the model "
                             "that the controller reports",
                             model, arm_models()));
}

double declare_watchdog_frequency(rcl_cxx::Node & node, double value)
{
  const double frequency =
      declare_number(node, "watchdog_frequency", value, 0.0, max_watchdog_frequency,
                     "Hz: the robot stops the arm after 1/watchdog_frequency s without a heartbeat of this "
                     "node; 0: no watchdog");
  if (const auto problem = watchdog_frequency_problem(frequency); !problem.empty()) {
    throw rcl_cxx::ParameterError("watchdog_frequency", "parameter " + problem);
  }
  return frequency;
}

StreamOptions declare_teleoperation(rcl_cxx::Node & node)
{
  StreamOptions options;
  options.timeout = declare_number(
      node, "stream_timeout", options.timeout, 0.02, 1.0,
      "s: without a message on servo_joint, servo_pose or twist for this time, teleoperation ends "
      "and the arm decelerates; it can start again after such a pause");
  options.max_joint_jump = declare_number(node, "stream_max_joint_jump", options.max_joint_jump, 0.001, 1.0,
                                          "rad: largest distance of a target from the last command, for each "
                                          "joint and for the rotation of a pose");
  options.max_linear_jump = declare_number(node, "stream_max_linear_jump", options.max_linear_jump, 0.001,
                                           1.0, "m: largest distance of a target pose from the last command");
  options.acceleration = declare_number(node, "stream_acceleration", options.acceleration, 0.01, 150.0,
                                        "m/s^2: acceleration of the TCP to the velocity of a twist");
  options.deceleration = declare_number(node, "stream_deceleration", options.deceleration, 0.1, 40.0,
                                        "rad/s^2 and m/s^2: deceleration at the end of teleoperation");
  options.lookahead_time =
      declare_number(node, "stream_lookahead_time", options.lookahead_time, 0.03, 0.2,
                     "s: lookahead time of servo_joint and servo_pose; small values track more closely");
  options.gain = declare_number(node, "stream_gain", options.gain, 100.0, 2000.0,
                                "Gain of the controller's position control for servo_joint and servo_pose");
  return options;
}
}  // namespace

std::string declare_robot_ip(rcl_cxx::Node & node)
{
  const auto address = node.declare_parameter(
      "robot_ip", "", read_only_descriptor("Address or host name of the robot's controller"));
  if (address.empty()) {
    const auto similar = most_similar("robot_ip", node.undeclared_overrides());
    throw rcl_cxx::ParameterError(
        "robot_ip",
        fmt::format("parameter robot_ip is not set{}: set the address of the robot's controller, for example "
                    "with --ros-args -p robot_ip:=192.168.0.10",
                    similar ? fmt::format(", but {} is, which does not exist", *similar) : ""));
  }
  return address;
}

std::chrono::milliseconds declare_silence_limit(rcl_cxx::Node & node)
{
  const double seconds = declare_number(
      node, "silence_limit", 0.1, 0.02, 10.0,
      "s: without data of the controller for this time, the connection is considered lost and motions end");
  return std::chrono::milliseconds(std::lround(1000.0 * seconds));
}

int declare_realtime_priority(rcl_cxx::Node & node)
{
  auto options = read_only_descriptor(
      "SCHED_FIFO priority of the threads that receive the robot's packages and send setpoints. 0: no "
      "real-time "
      "scheduling");
  options.integer_range = rcl_cxx::IntegerRange{0, 99};
  return static_cast<int>(node.declare_parameter<int>("realtime_priority", 0, options));
}

PluginChoice declare_plugin_choice(rcl_cxx::Node & node)
{
  const std::vector<std::string> none;
  return {node.declare_parameter("plugins", none,
                                 read_only_descriptor("Names of the plugins to load, which are the names of "
                                                      "their actions. Empty: all installed plugins")),
          node.declare_parameter("plugins_blacklist", none,
                                 read_only_descriptor("Names of plugins not to load"))};
}

bool declare_servers_on_demand(rcl_cxx::Node & node)
{
  return declare_choice(
             node, "servers", "on_demand", {"on_demand", "always"},
             "When the endpoints of an action are created: for its first action client, or at the start. "
             "Clients that use the services of an action without an action client need \"always\"") ==
         "on_demand";
}

RobotStateReceiver::Options declare_state_options(rcl_cxx::Node & node)
{
  RobotStateReceiver::Options options;
  options.tf_prefix = declare_tf_prefix(node);
  options.qos = declare_choice(node, "qos", "reliable", rcl_cxx::QoS::names(),
                               "Quality of service of the published state");
  options.frequency = declare_number(node, "rtde_frequency", 500.0, 1.0, 500.0,
                                     "Hz: rate of the published state; at most 125 with a CB3 controller");
  options.fields = declare_robot_state_fields(node);
  options.publish_tf = node.declare_parameter(
      "publish_tf", true,
      read_only_descriptor("Broadcast the transform base -> tool0_controller, the TCP pose, on /tf"));
  return options;
}

CommandServerParameters declare_command_server(rcl_cxx::Node & node)
{
  CommandServerParameters parameters;
  parameters.tf_prefix = parameters.goals.tf_prefix = declare_tf_prefix(node);
  RobotOptions & robot = parameters.robot;
  robot.address = declare_robot_ip(node);
  robot.control_mode =
      declare_choice(
          node, "control_mode", "upload", {"upload", "control_urcap"},
          "How the control program gets to the robot: uploaded by the driver (an e-Series robot must be in "
          "remote control), or fetched by the External Control URCap") == "upload"
          ? ControlMode::upload
          : ControlMode::control_urcap;
  auto port = read_only_descriptor("Port on which this node serves the External Control URCap");
  port.integer_range = rcl_cxx::IntegerRange{1, 65535};
  robot.urcap_port = static_cast<std::uint16_t>(node.declare_parameter<int>("urcap_port", 50002, port));
  robot.urcap_extensions = node.declare_parameter(
      "urcap_extensions", false,
      read_only_descriptor("With control_urcap: the robot has the URCaps whose functions commands need"));
  robot.silence_limit = declare_silence_limit(node);
  robot.realtime_priority = declare_realtime_priority(node);
  robot.watchdog_frequency = declare_watchdog_frequency(node, robot.watchdog_frequency);
  robot.restart_program = node.declare_parameter(
      "restart_program", true,
      read_only_descriptor("Restart the control program after it was stopped. Interrupted motions are never "
                           "resumed"));
  parameters.goals.preempt_when_busy =
      declare_choice(
          node, "on_busy", "reject", {"reject", "preempt"},
          "What happens to a motion goal while another motion is active: it is rejected, or it preempts "
          "the active one") == "preempt";
  parameters.goals.stop_when_client_lost =
      declare_choice(node, "on_client_lost", "stop", {"stop", "continue"},
                     "What happens to a goal whose client has disappeared: the arm decelerates to a "
                     "standstill and the goal ends with CLIENT_LOST, or the goal continues") == "stop";
  parameters.goals.servers_on_demand = declare_servers_on_demand(node);
  robot.model = declare_model(node);
  robot.upper_range_registers =
      declare_choice(node, "register_range", "lower", {"lower", "upper"},
                     "General purpose registers that the driver uses: 0 to 23, or 24 to 47 "
                     "if a fieldbus (EtherNet/IP, PROFINET, MODBUS) uses the lower ones") == "upper";
  parameters.teleoperation = declare_teleoperation(node);
  return parameters;
}

}  // namespace ur_ros_rtde
