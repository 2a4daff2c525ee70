#pragma once

#include <string>

namespace ur_ros_rtde {

/// Reserves a name among the processes of this host while it exists, even if the process is killed.
/// Containers with a network of their own count as other hosts.
class HostNameLock {
 public:
  explicit HostNameLock(const std::string & name);
  ~HostNameLock();
  HostNameLock(const HostNameLock &) = delete;
  HostNameLock & operator=(const HostNameLock &) = delete;

  /// True if another process of this host has reserved the name.
  bool taken_by_other() const { return taken_; }

 private:
  int socket_ = -1;
  bool taken_ = false;
};

}  // namespace ur_ros_rtde
