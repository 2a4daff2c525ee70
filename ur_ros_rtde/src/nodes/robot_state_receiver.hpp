#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <string>
#include <ur_ros_rtde_msgs/srv/get_io_state.hpp>
#include <ur_ros_rtde_msgs/srv/get_joint_state.hpp>
#include <ur_ros_rtde_msgs/srv/get_tcp_pose.hpp>
#include <ur_ros_rtde_msgs/srv/get_wrench.hpp>
#include <vector>

#include "diagnostics/state_diagnostics.hpp"
#include "recording/recording_services.hpp"
#include "recording/stop_recorder.hpp"
#include "state/fake_joints.hpp"
#include "state/field_topics.hpp"
#include "state/state_messages.hpp"
#include "state/status_topics.hpp"
#include "state/tool_transform.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Publishes the state from each sample and answers services from the newest one. The samples come from a
/// StateReceiver, or from the Robot of a command_server in the same process.
class RobotStateReceiver {
 public:
  struct Options {
    std::string tf_prefix;
    std::string qos = "reliable";
    /// Broadcast base -> tool0_controller.
    bool publish_tf = true;
    /// Hz
    double frequency = 500.0;
    /// RTDE outputs that are published on robot_state.
    std::vector<std::string> fields;
    std::string address;
  };
  using Source = std::function<StateSource()>;

  RobotStateReceiver(rcl_cxx::Node & node, Options options, Source source);

  /// Runs on the receiving thread and does not allocate.
  void publish(const Sample & sample);

 private:
  template <typename S, typename M>
  typename rcl_cxx::Service<S>::SharedPtr serve(const std::string & name, M StateMessages::* source,
                                                M S::Response::* destination);
  Status freshness() const;
  bool is_due(const Sample & sample);
  template <typename M>
  void publish_if_subscribed(rcl_cxx::Publisher<M> & publisher, const M & message) const;
  void enable_fake_joints(const std_srvs::srv::SetBool::Request & request,
                          std_srvs::srv::SetBool::Response & response);
  void set_fake_joints(const sensor_msgs::msg::JointState & message);
  std::vector<Diagnosis> diagnose();

  rcl_cxx::Node & node_;
  const Options options_;
  const Source source_;
  mutable std::mutex mutex_;
  StateMessages newest_;  ///< never the fake joint states
  std::optional<Sample> received_;
  std::uint32_t link_ = 0;
  double next_due_ = 0.0;
  FakeJoints fake_;
  sensor_msgs::msg::JointState published_joint_state_;
  StatusTopics status_topics_;
  PackageStatistics packages_;
  double agreed_frequency_ = 0.0;  ///< of link_
  bool keeps_messages_ = false;    ///< The quality of service keeps messages for later subscribers.

  rcl_cxx::Publisher<sensor_msgs::msg::JointState>::SharedPtr joint_states_;
  rcl_cxx::Publisher<sensor_msgs::msg::JointState>::SharedPtr actual_joint_states_;
  rcl_cxx::Publisher<geometry_msgs::msg::PoseStamped>::SharedPtr tcp_pose_;
  rcl_cxx::Publisher<geometry_msgs::msg::WrenchStamped>::SharedPtr wrench_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::IOState>::SharedPtr io_state_;
  rcl_cxx::Publisher<geometry_msgs::msg::TwistStamped>::SharedPtr tcp_speed_;
  rcl_cxx::Publisher<sensor_msgs::msg::JointState>::SharedPtr target_joint_states_;
  std::optional<ToolTransform> tool_transform_;  ///< if publish_tf is true
  rcl_cxx::Service<ur_ros_rtde_msgs::srv::GetJointState>::SharedPtr get_joint_state_;
  rcl_cxx::Service<ur_ros_rtde_msgs::srv::GetTcpPose>::SharedPtr get_tcp_pose_;
  rcl_cxx::Service<ur_ros_rtde_msgs::srv::GetWrench>::SharedPtr get_wrench_;
  rcl_cxx::Service<ur_ros_rtde_msgs::srv::GetIOState>::SharedPtr get_io_state_;
  rcl_cxx::Publisher<std_msgs::msg::Bool>::SharedPtr joint_states_are_fake_;
  rcl_cxx::Service<std_srvs::srv::SetBool>::SharedPtr publish_fake_;
  rcl_cxx::Subscription<sensor_msgs::msg::JointState>::SharedPtr fake_joint_states_;
  FieldTopics field_topics_;
  RecordingServices recording_;
  StopRecorder stop_recorder_;
  Diagnostics diagnostics_;
};

}  // namespace ur_ros_rtde
