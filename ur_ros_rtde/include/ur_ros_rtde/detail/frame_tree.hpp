#pragma once

#include <chrono>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The frames of TF, connected by the newest transforms.
class FrameTree {
 public:
  using Clock = std::chrono::steady_clock;
  /// The age at which a transform of the topic tf no longer says where its frame is. It counts from the
  /// reception, because the publisher may run on a host with another clock.
  static constexpr std::chrono::seconds longest_age{2};

  /// `received`: empty for a transform of tf_static, which stays valid. A transform that is not finite or has
  /// no rotation is ignored.
  void add(const geometry_msgs::msg::TransformStamped & transform, std::optional<Clock::time_point> received);
  /// The pose of `frame` in `base`: position (m) and rotation vector (rad). Fails (invalid_goal) with the
  /// reason: unknown, not connected with `base`, or not published since `longest_age`.
  Expected<Vector6> pose(const std::string & frame, const std::string & base, Clock::time_point now) const;

 private:
  struct Link {
    std::string parent;
    Vector6 pose{};  ///< in the parent
    std::optional<Clock::time_point> received;
  };
  /// A frame that has no parent, and the pose of another one in it.
  struct InRoot {
    std::string root;
    Vector6 pose{};
  };
  Expected<InRoot> in_root(const std::string & frame, Clock::time_point now) const;
  bool knows(const std::string & frame) const;

  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace ur_ros_rtde
