#pragma once

#include <chrono>
#include <deque>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The frames of TF. As in tf2, a pose is that of the latest time at which all transforms on the way are
/// known: a part that a camera on the arm has seen stays where it was seen.
class FrameTree {
 public:
  using Clock = std::chrono::steady_clock;
  /// The age at which a transform of the topic tf no longer says where its frame is. It counts from the
  /// reception, because the publisher may run on a host with another clock.
  static constexpr std::chrono::seconds longest_age{2};

  /// `received`: empty for a transform of tf_static, which stays valid. A transform that is not finite, has
  /// no rotation or connects a frame with itself is ignored, as is one that is older than the last one.
  void add(const geometry_msgs::msg::TransformStamped & transform, std::optional<Clock::time_point> received);
  /// The pose of `frame` in `base`: position (m) and rotation vector (rad). Fails (invalid_goal) with the
  /// reason: unknown, not connected with `base`, not published since `longest_age`, no common time.
  Expected<Vector6> pose(const std::string & frame, const std::string & base, Clock::time_point now) const;

 private:
  using Stamp = std::chrono::nanoseconds;  ///< by the clock of the publisher
  struct Link {
    std::string parent;
    std::deque<std::pair<Stamp, Vector6>> poses;  ///< in the parent, by time; of a static one, one
    std::optional<Clock::time_point> received;    ///< the last one
    /// Empty: there is none of that time.
    std::optional<Vector6> at(Stamp stamp) const;
  };
  using Links = std::map<std::string, Link>;  ///< by child
  /// The links between a frame and the one above it that has no parent.
  struct Way {
    std::vector<Links::const_iterator> links;
    std::string root;
    /// The newest time at which each of the links is known.
    Stamp newest() const;
    /// The pose of the frame in the root at this time. Fails with the name of a frame that was not known
    /// then.
    tl::expected<Vector6, std::string> pose_in_root(Stamp stamp) const;
  };
  Expected<Way> way(const std::string & frame, Clock::time_point now) const;
  bool knows(const std::string & frame) const;
  void forget_lost(Clock::time_point now);

  Links links_;
};

}  // namespace ur_ros_rtde
