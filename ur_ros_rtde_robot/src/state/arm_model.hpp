#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_trajectory/arm.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The model with this type number in the primary interface; none if the number is unknown. A UR7e reports
/// the number of the UR5e, a UR12e that of the UR10e, since the arms are identical.
std::optional<std::string> model_of_type(std::int32_t type, bool cb3);

/// Model of the arm, as stated by the user and as detected from the controller, and its limits. Thread-safe.
class ArmModel {
 public:
  /// `stated`: model given by the user; empty: use the detected one. Throws std::invalid_argument if it is
  /// unknown.
  ArmModel(std::string address, std::string stated, LogFunction log);

  /// Queries the controller; `timeout` applies to each step. Logs changes.
  void detect(const ControllerVersion & version, std::chrono::milliseconds timeout);
  /// Limits of the stated or else the detected model. If both are unknown: the limits that all models have in
  /// common.
  ArmLimits limits() const;
  /// Name of the stated or else the detected model. Empty if both are unknown.
  std::string name() const;
  /// Calibrated kinematics, as the controller reports them; none before detect() has received them.
  std::optional<kinematics::DhRows> calibration() const;
  /// Error if the detected model differs from the stated one.
  std::optional<Error> mismatch() const;

 private:
  void report_undetected(const std::string & why);

  const std::string address_;
  const std::string stated_;
  ChangeLogger logger_;  ///< used by detect() only
  mutable std::mutex mutex_;
  std::optional<std::string> detected_;
  ArmLimits limits_;
  std::optional<kinematics::DhRows> calibration_;
};

}  // namespace ur_ros_rtde
