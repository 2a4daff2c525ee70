#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <rcl_cxx/node.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "ur_ros_rtde/detail/frame_tree.hpp"

namespace ur_ros_rtde {

/// Where the frames of TF are. Thread-safe. Subscribes to /tf and /tf_static when it is first asked, so that
/// a driver whose goals are all in `base` does not receive them.
class Frames {
 public:
  /// How long a goal waits for the discovery of the publishers, and for a frame that is published rarely.
  static constexpr std::chrono::seconds longest_wait{2};

  /// `base`: the frame of the controller, with the prefix of this arm. `group`: of the callbacks.
  Frames(rcl_cxx::Node & node, std::string base, rcl_cxx::CallbackGroup::SharedPtr group);

  const std::string & base() const { return base_; }
  /// The newest pose of `frame` in `base`: position (m) and rotation vector (rad). Waits until TF has it, at
  /// most `timeout`, unless `stop` is requested. Fails (invalid_goal) with the reason and the remedy.
  Expected<Vector6> pose(const std::string & frame, const std::stop_token & stop,
                         std::chrono::nanoseconds timeout = longest_wait);

 private:
  /// Once.
  void subscribe();

  rcl_cxx::Node & node_;
  const std::string base_;
  const rcl_cxx::CallbackGroup::SharedPtr group_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  FrameTree tree_;
  std::vector<std::shared_ptr<rcl_cxx::SubscriptionBase>> subscriptions_;  ///< their callbacks use the rest
};

}  // namespace ur_ros_rtde
