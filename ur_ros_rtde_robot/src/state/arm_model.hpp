#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/reporter.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The model with this type number in the primary interface; none for a number that is not known. A UR7e
/// says that it is a UR5e, a UR12e that it is a UR10e: the arms are the same.
std::optional<std::string> model_of_type(std::int32_t type, bool cb3);

/// Which model the arm is, by the user and by the controller, and what it can do. Thread-safe.
class ArmModel {
 public:
  /// `stated` by the user; empty: the detected one. Throws std::invalid_argument for an unknown
  /// model.
  ArmModel(std::string address, std::string stated, LogFunction log);

  /// Asks the controller, within some `limit`s. Says in the log what is new.
  void detect(const ControllerVersion & version, std::chrono::milliseconds limit);
  /// Of the stated model, or the detected one. When the controller has not told: what every model can do.
  ArmLimits limits() const;
  /// The controller has another model than the stated one.
  std::optional<Error> mismatch() const;

 private:
  void could_not_detect(const std::string & why);

  const std::string address_;
  const std::string stated_;
  Reporter report_;  ///< used by detect() only
  mutable std::mutex mutex_;
  std::optional<std::string> detected_;
  ArmLimits limits_;
};

}  // namespace ur_ros_rtde
