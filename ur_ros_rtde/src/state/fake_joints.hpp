#pragma once

#include <map>
#include <mutex>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <tl/expected.hpp>

namespace ur_ros_rtde {

/// The joint positions that are published on joint_states while publish_fake_joint_states is on: the
/// positions at that moment, then the values received on fake_joint_states for each joint. Thread-safe.
class FakeJoints {
 public:
  /// `real`: the current joint states. Its names are the joints that can be faked.
  void begin(const sensor_msgs::msg::JointState & real);
  void end();
  bool active() const;
  /// Sets the positions of the joints named in `message`. If the message is invalid, nothing changes, and the
  /// error names the cause.
  tl::expected<void, std::string> set(const sensor_msgs::msg::JointState & message);
  /// Writes the fake positions, with zero velocity and effort, and keeps the stamp. False if not active.
  bool apply(sensor_msgs::msg::JointState & shown) const;

 private:
  mutable std::mutex mutex_;
  bool active_ = false;
  sensor_msgs::msg::JointState joints_;
};

}  // namespace ur_ros_rtde
