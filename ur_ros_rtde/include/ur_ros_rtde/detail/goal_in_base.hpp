#pragma once

#include <algorithm>
#include <geometry_msgs/msg/pose.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "ur_ros_rtde/frames.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

/// The poses that a goal's field `frame_id` applies to: its fields `pose`, `via` and `poses`, and `pose` and
/// `via` of its `waypoints`.
template <typename Message, typename F>
void for_each_pose(Message & message, const F & change)
{
  const auto change_in = [&](auto & part) {
    if constexpr (requires { part.pose; }) {
      change(part.pose);
    }
    if constexpr (requires { part.via; }) {
      change(part.via);
    }
  };
  change_in(message);
  if constexpr (requires { message.poses; }) {
    std::ranges::for_each(message.poses, change);
  }
  if constexpr (requires { message.waypoints; }) {
    std::ranges::for_each(message.waypoints, change_in);
  }
}

/// A goal whose poses are given in the frame of its field `frame_id`.
template <typename Message>
concept GivenInFrame = requires(const Message & message) { message.frame_id; } &&
                       (requires(const Message & message) { message.pose; } ||
                        requires(const Message & message) { message.poses; } ||
                        requires(const Message & message) { message.waypoints; });

/// `pose`, given in a frame whose pose in `base` is `frame` (position in m, rotation vector in rad), in
/// `base`. An orientation that is not valid is left as it is.
geometry_msgs::msg::Pose in_base(const Vector6 & frame, const geometry_msgs::msg::Pose & pose);

/// A goal, and the same goal with its poses in `base`.
template <typename Message>
class GoalInBase {
 public:
  explicit GoalInBase(const Message & message) : message_(message) {}

  const Message & operator*() const { return resolved_ ? *resolved_ : message_; }
  /// Its poses are given in another frame than `base`, the name of that of the controller.
  bool has_frame(const std::string & base) const
  {
    if constexpr (GivenInFrame<Message>) {
      return !message_.frame_id.empty() && message_.frame_id != base;
    }
    return false;
  }
  /// Transforms the poses of a goal that has a frame. Waits for TF; see Frames::pose().
  Status resolve(Frames & frames, const std::stop_token & stop)
  {
    if constexpr (GivenInFrame<Message>) {
      const auto frame = frames.pose(message_.frame_id, stop);
      if (!frame) {
        return failure(frame.error().code, "frame_id: " + frame.error().message);
      }
      transform(*frame);
    }
    return {};
  }
  /// The same with the pose of the frame in `base`: position (m) and rotation vector (rad).
  void transform(const Vector6 & frame)
  {
    resolved_ = message_;
    for_each_pose(*resolved_, [&](geometry_msgs::msg::Pose & pose) { pose = in_base(frame, pose); });
    // An orientation that the goal gives may be the identity in `base`; see tcp_target().
    if constexpr (requires { resolved_->identity_orientation; }) {
      if (!message_.identity_orientation && has_identity_orientation(message_.pose)) {
        resolved_->pose.orientation = message_.pose.orientation;
      } else {
        resolved_->identity_orientation = true;
      }
    }
  }

 private:
  const Message & message_;
  std::optional<Message> resolved_;
};

}  // namespace ur_ros_rtde
