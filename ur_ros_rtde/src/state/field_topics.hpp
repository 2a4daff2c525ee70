#pragma once

#include <functional>
#include <rcl_cxx/node.hpp>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <ur_ros_rtde_msgs/msg/robot_state.hpp>
#include <ur_ros_rtde_msgs/msg/tool_data.hpp>
#include <vector>

#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"

namespace ur_ros_rtde {

/// Publishes tool_data, and robot_state with the configured RTDE fields, which a Sample does not contain.
/// Uses its own connection and thread, which exist only while tool_data has subscribers or fields are
/// configured.
class FieldTopics {
 public:
  struct Options {
    std::string address;
    std::string tf_prefix;
    std::string qos;
    double frequency = 0.0;           ///< Hz
    std::vector<std::string> fields;  ///< of robot_state; empty: the topic is not created
  };

  FieldTopics(rcl_cxx::Node & node, Options options, LogFunction log);
  /// Ends the thread. Takes at most as long as one step of connecting.
  ~FieldTopics() = default;
  FieldTopics(const FieldTopics &) = delete;
  FieldTopics & operator=(const FieldTopics &) = delete;

 private:
  void run(const std::stop_token & stop);
  bool tool_wanted() const { return tool_data_->get_subscription_count() > 0; }
  Status follow(RtdeSubscription & subscription, bool with_tool, const std::stop_token & stop);
  /// Sets up the fields of robot_state and stores the positions of their values.
  void set_up_fields(const RtdeSubscription & subscription);
  void publish_tool(std::span<const double> numbers);
  void publish_state(std::span<const double> numbers);

  const Options options_;
  ChangeLogger logger_;
  std::vector<std::size_t> begins_;  ///< position of each field of robot_state in a package
  ur_ros_rtde_msgs::msg::ToolData tool_;
  ur_ros_rtde_msgs::msg::RobotState state_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::ToolData>::SharedPtr tool_data_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::RobotState>::SharedPtr robot_state_;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
