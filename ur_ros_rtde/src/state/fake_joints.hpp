#pragma once

#include <map>
#include <mutex>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <tl/expected.hpp>

namespace ur_ros_rtde {

/// What joint_states shows while publish_fake_joint_states is on: the positions at that moment, and then what
/// fake_joint_states gives for each joint that it names. Thread-safe.
class FakeJoints {
 public:
  /// `real` is what joint_states shows now; its names are the joints that can be faked.
  void begin(const sensor_msgs::msg::JointState & real);
  void end();
  bool active() const;
  /// Takes the positions of the joints that `message` names. The error names what is wrong with it, and
  /// nothing of it is taken.
  tl::expected<void, std::string> set(const sensor_msgs::msg::JointState & message);
  /// The positions now shown, at rest and without effort; stamp as in `shown`. False if not active.
  bool apply(sensor_msgs::msg::JointState & shown) const;

 private:
  mutable std::mutex mutex_;
  bool active_ = false;
  sensor_msgs::msg::JointState joints_;
};

}  // namespace ur_ros_rtde
