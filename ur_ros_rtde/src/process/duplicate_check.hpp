#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <std_msgs/msg/header.hpp>
#include <string>

namespace ur_ros_rtde {

/// Detects another process with a node of the same name: two servers of the same actions would both answer a
/// client. Each process publishes its start time (stamp) and identity (frame_id) on the hidden transient
/// local topic `~/_instance`. A killed process stops publishing, even while its node is still listed.
class DuplicateCheck {
 public:
  /// Calls `reject` with the reason if an older process is found shortly after the start; later, an error is
  /// logged. Runs in the executor's thread.
  DuplicateCheck(rcl_cxx::Node & node, std::function<void(const std::string & why)> reject);
  /// For use before the node has an executor: the reason to reject, if an older process has been found.
  std::optional<std::string> find_older();

 private:
  using Instance = std_msgs::msg::Header;
  void on_instance(const Instance & other);
  Instance own_running() const;
  bool is_own(const Instance & other) const;
  bool is_older(const Instance & other) const;
  std::string conflict_with(const Instance & other) const;
  std::string rejection(const Instance & other) const;

  rcl_cxx::Node & node_;
  const std::function<void(const std::string &)> reject_;
  const Instance own_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  rcl_cxx::Publisher<Instance>::SharedPtr publisher_;
  rcl_cxx::Subscription<Instance>::SharedPtr subscription_;
};

}  // namespace ur_ros_rtde
