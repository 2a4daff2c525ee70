#pragma once

#include <chrono>
#include <functional>
#include <rcl_cxx/node.hpp>
#include <std_msgs/msg/header.hpp>
#include <string>

namespace ur_ros_rtde {

/// Notices another process whose node has the same name: two servers of the same actions would both answer a
/// client. Each process tells on the hidden topic `~/_instance` since when it runs (the stamp) and which it
/// is (the frame_id), to late subscribers too. A process that was killed tells nothing any more, even while
/// its node is still listed.
class DuplicateCheck {
 public:
  /// `refuse` gets the reason why this process has to end: an older one is there, and this one has only just
  /// started. Later, the log says so. Runs in the executor's thread.
  DuplicateCheck(rcl_cxx::Node & node, std::function<void(const std::string & why)> refuse);

 private:
  using Instance = std_msgs::msg::Header;
  void hear(const Instance & other);

  rcl_cxx::Node & node_;
  const std::function<void(const std::string &)> refuse_;
  const Instance own_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  rcl_cxx::Publisher<Instance>::SharedPtr publisher_;
  rcl_cxx::Subscription<Instance>::SharedPtr subscription_;
};

}  // namespace ur_ros_rtde
