#include "state/state_messages.hpp"

#include <algorithm>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

builtin_interfaces::msg::Time to_time(std::chrono::system_clock::time_point stamp)
{
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(stamp.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  builtin_interfaces::msg::Time time;
  time.sec = static_cast<std::int32_t>(seconds.count());
  time.nanosec = static_cast<std::uint32_t>((since - seconds).count());
  return time;
}

StateMessages::StateMessages(const std::string & tf_prefix)
{
  for (const std::string & name : joint_names()) {
    joint_state.name.push_back(tf_prefix + name);
  }
  joint_state.position.resize(6);
  joint_state.velocity.resize(6);
  joint_state.effort.resize(6);
  target_joint_state = joint_state;
  tcp_pose.header.frame_id = tf_prefix + "base";
  tcp_speed.header.frame_id = tf_prefix + "base";
  wrench.header.frame_id = tf_prefix + "tool0_controller";
}

void StateMessages::fill(const Sample & sample)
{
  const auto stamp = to_time(sample.stamp);
  joint_state.header.stamp = stamp;
  target_joint_state.header.stamp = stamp;
  tcp_speed.header.stamp = stamp;
  tcp_pose.header.stamp = stamp;
  wrench.header.stamp = stamp;
  io_state.header.stamp = stamp;

  const Vector6 efforts = efforts_.update(sample);
  std::copy(sample.actual_q.begin(), sample.actual_q.end(), joint_state.position.begin());
  std::copy(sample.actual_qd.begin(), sample.actual_qd.end(), joint_state.velocity.begin());
  std::copy(efforts.begin(), efforts.end(), joint_state.effort.begin());

  std::copy(sample.target_q.begin(), sample.target_q.end(), target_joint_state.position.begin());
  std::copy(sample.target_qd.begin(), sample.target_qd.end(), target_joint_state.velocity.begin());
  std::copy(sample.target_moment.begin(), sample.target_moment.end(), target_joint_state.effort.begin());
  fill_tool(sample);

  for (std::size_t pin = 0; pin < io_state.digital_inputs.size(); ++pin) {
    io_state.digital_inputs[pin] = ((sample.digital_inputs >> pin) & 1U) != 0;
    io_state.digital_outputs[pin] = ((sample.digital_outputs >> pin) & 1U) != 0;
  }
  io_state.analog_inputs = sample.analog_inputs;
  io_state.analog_outputs = sample.analog_outputs;
}

void StateMessages::fill_tool(const Sample & sample)
{
  const Vector6 & pose = sample.actual_tcp_pose;
  const Quaternion q = quaternion(rotation(pose));
  tcp_pose.pose.position.x = pose[0];
  tcp_pose.pose.position.y = pose[1];
  tcp_pose.pose.position.z = pose[2];
  tcp_pose.pose.orientation.x = q.x;
  tcp_pose.pose.orientation.y = q.y;
  tcp_pose.pose.orientation.z = q.z;
  tcp_pose.pose.orientation.w = q.w;

  const Vector6 & speed = sample.actual_tcp_speed;
  tcp_speed.twist.linear.x = speed[0];
  tcp_speed.twist.linear.y = speed[1];
  tcp_speed.twist.linear.z = speed[2];
  tcp_speed.twist.angular.x = speed[3];
  tcp_speed.twist.angular.y = speed[4];
  tcp_speed.twist.angular.z = speed[5];

  const Vector6 force = tcp_frame_force(sample);
  wrench.wrench.force.x = force[0];
  wrench.wrench.force.y = force[1];
  wrench.wrench.force.z = force[2];
  wrench.wrench.torque.x = force[3];
  wrench.wrench.torque.y = force[4];
  wrench.wrench.torque.z = force[5];
}

}  // namespace ur_ros_rtde
