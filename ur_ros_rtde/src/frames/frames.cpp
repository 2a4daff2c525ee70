#include "ur_ros_rtde/frames.hpp"

#include <fmt/format.h>

#include <tf2_msgs/msg/tf_message.hpp>
#include <utility>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/detail/goal_in_base.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

Frames::Frames(rcl_cxx::Node & node, std::string base, rcl_cxx::CallbackGroup::SharedPtr group)
    : node_(node), base_(std::move(base)), group_(std::move(group))
{
}

void Frames::subscribe()
{
  const std::lock_guard lock(mutex_);
  if (!subscriptions_.empty()) {
    return;
  }
  const auto subscribe_to = [this](const char * topic, const rcl_cxx::QoS & qos, bool is_static) {
    subscriptions_.push_back(node_.create_subscription<tf2_msgs::msg::TFMessage>(
        topic, qos,
        [this, is_static](const tf2_msgs::msg::TFMessage & message) {
          const auto now = FrameTree::Clock::now();
          {
            const std::lock_guard tree_lock(mutex_);
            for (const auto & transform : message.transforms) {
              tree_.add(transform, is_static ? std::nullopt : std::optional(now));
            }
          }
          changed_.notify_all();
        },
        group_));
  };
  subscribe_to("/tf", rcl_cxx::QoS::reliable(100), false);
  subscribe_to("/tf_static", rcl_cxx::QoS::transient_local(100), true);
}

Expected<Vector6> Frames::pose(const std::string & frame, const std::stop_token & stop,
                               std::chrono::nanoseconds timeout)
{
  if (frame == base_) {
    return Vector6{};
  }
  subscribe();
  std::unique_lock lock(mutex_);
  auto pose = tree_.pose(frame, base_, FrameTree::Clock::now());
  if (!pose) {
    changed_.wait_for(lock, stop, timeout, [&] {
      pose = tree_.pose(frame, base_, FrameTree::Clock::now());
      return pose.has_value();
    });
  }
  if (pose) {
    return pose;
  }
  return failure(
      pose.error().code,
      fmt::format("{}; waited {:.2g} s for it: does its publisher run, and robot_state_publisher for "
                  "the frames of the arm?",
                  pose.error().message, std::chrono::duration<double>(timeout).count()));
}

geometry_msgs::msg::Pose in_base(const Vector6 & frame, const geometry_msgs::msg::Pose & pose)
{
  const auto & p = pose.position;
  const auto & q = pose.orientation;
  const auto orientation = rotation_vector({q.x, q.y, q.z, q.w});
  const Vector3 r = orientation.value_or(Vector3{});
  auto result = to_ros(pose_trans(frame, {p.x, p.y, p.z, r[0], r[1], r[2]}));
  if (!orientation) {
    result.orientation = q;
  }
  return result;
}

}  // namespace ur_ros_rtde
