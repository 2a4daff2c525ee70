#pragma once

#include <memory>
#include <optional>
#include <rcl_cxx/node.hpp>
#include <std_msgs/msg/string.hpp>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "state/description_kinematics.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// Compares the URDF on the topic robot_description with the kinematics that the controller of the arm
/// reports. Logs a warning once for each description that deviates. All functions run in the executor's
/// thread.
class DescriptionCheck {
 public:
  DescriptionCheck(rcl_cxx::Node & node, Robot & robot, std::string prefix);

  /// Compares, as soon as description and calibration are known. Call regularly. Empty without a description
  /// of the arm, or without calibration.
  std::optional<Diagnosis> diagnose();

 private:
  void warn_once(const std::string & finding);

  rcl_cxx::Node & node_;
  Robot & robot_;
  const std::string prefix_;
  std::optional<JointOrigins> description_;
  bool warned_ = false;  ///< of this description
  rcl_cxx::Subscription<std_msgs::msg::String>::SharedPtr subscription_;
};

}  // namespace ur_ros_rtde
