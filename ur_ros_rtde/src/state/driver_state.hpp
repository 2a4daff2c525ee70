#pragma once

#include <rcl_cxx/node.hpp>
#include <ur_ros_rtde_msgs/msg/driver_state.hpp>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// Publishes driver_state on each change. Transient local: late subscribers receive the last value.
class DriverStateTopic {
 public:
  explicit DriverStateTopic(rcl_cxx::Node & node);
  /// Thread-safe.
  void publish(const RobotStatus & status);

 private:
  rcl_cxx::Node & node_;
  rcl_cxx::Publisher<ur_ros_rtde_msgs::msg::DriverState>::SharedPtr publisher_;
};

/// The state of the driver for /diagnostics, with the active goals. ERROR if the robot cannot be reached or
/// is in a safety stop, WARN if it cannot move for another reason.
std::vector<Diagnosis> diagnose_driver(Robot & robot);

}  // namespace ur_ros_rtde
