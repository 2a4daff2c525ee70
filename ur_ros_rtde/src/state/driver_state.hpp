#pragma once

#include <rcl_cxx/node.hpp>
#include <ur_ros_rtde_msgs/msg/driver_state.hpp>
#include <vector>

#include "state/diagnostics.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// driver_state: what the driver makes of the robot, on each change; who comes later gets the last.
class DriverStateTopic {
 public:
  explicit DriverStateTopic(rcl_cxx::Node & node);
  /// Thread-safe.
  void publish(const RobotStatus & status);

 private:
  rcl_cxx::Node & node_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::DriverState>::SharedPtr publisher_;
};

/// The same for /diagnostics, with the goals that have the robot. ERROR when it cannot be reached or is
/// stopped for its safety, WARN when it cannot move for another reason.
std::vector<Diagnosis> diagnose_driver(Robot & robot);

}  // namespace ur_ros_rtde
