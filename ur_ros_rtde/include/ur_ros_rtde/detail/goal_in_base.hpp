#pragma once

#include <algorithm>
#include <concepts>
#include <geometry_msgs/msg/pose.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <type_traits>

#include "ur_ros_rtde/frames.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

template <typename T>
concept IsPose = std::same_as<std::remove_cvref_t<T>, geometry_msgs::msg::Pose>;
template <typename T>
concept HasPose = requires(T & message) { requires IsPose<decltype(message.pose)>; };
template <typename T>
concept HasVia = requires(T & message) { requires IsPose<decltype(message.via)>; };
template <typename T>
concept HasPoses = requires(T & message) { requires IsPose<decltype(message.poses.front())>; };
template <typename T>
concept HasWaypoints = requires(T & message) {
  requires IsPose<decltype(message.waypoints.front())> ||
               HasPose<std::remove_reference_t<decltype(message.waypoints.front())>>;
};

/// A goal whose poses are given in the frame of its field `frame_id`.
template <typename T>
concept GivenInFrame = requires(T & message) {
  requires std::same_as<std::remove_cvref_t<decltype(message.frame_id)>, std::string>;
} && (HasPose<T> || HasVia<T> || HasPoses<T> || HasWaypoints<T>);

/// Calls `change` with the poses that a goal's field `frame_id` applies to: its fields `pose`, `via` and
/// `poses`, and its `waypoints`, or their fields `pose` and `via`.
template <typename Message, typename F>
void for_each_pose(Message & message, const F & change)
{
  const auto change_in = [&change]<typename Part>(Part & part) {
    if constexpr (IsPose<Part>) {
      change(part);
    }
    if constexpr (HasPose<Part>) {
      change(part.pose);
    }
    if constexpr (HasVia<Part>) {
      change(part.via);
    }
  };
  change_in(message);
  if constexpr (HasPoses<Message>) {
    std::ranges::for_each(message.poses, change);
  }
  if constexpr (HasWaypoints<Message>) {
    std::ranges::for_each(message.waypoints, change_in);
  }
}

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
  /// Transforms the poses if it has a frame. Waits for TF; see Frames::pose().
  Status resolve(Frames & frames, const std::stop_token & stop)
  {
    if constexpr (GivenInFrame<Message>) {
      if (!has_frame(frames.base())) {
        return {};
      }
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
    if constexpr (HasPose<Message> && requires { resolved_->identity_orientation; }) {
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
