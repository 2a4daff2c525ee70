#pragma once

#include <array>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/action/move_until_force.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Moves until the force or the torque on the TCP reaches a threshold. Every package of the controller is
/// evaluated, so that the stop begins two cycles after the package that exceeds the threshold.
class MoveUntilWrench : public Command<ur_ros_rtde_msgs::action::MoveUntilForce> {
 public:
  struct WrenchPart {
    std::size_t first;     ///< index in the wrench: 0 for the force, 3 for the torque
    double max_threshold;  ///< N or Nm
    std::string unit;
  };

  explicit MoveUntilWrench(WrenchPart part) : part_(std::move(part)) {}

 private:
  void check(const Goal & goal, Check & check) const override;
  StopOptions stop_options(const Goal & goal) const override
  {
    return {.linear_deceleration = goal.deceleration};
  }
  Outcome run(const Goal & goal, Run & run) override;

  /// The selected components in the frame of the goal; the others are zero.
  Vector3 measure(const Goal & goal, const Sample & sample) const;
  /// Measures the offset at rest: the mean of 10 packages.
  std::optional<StopReason> measure_offset(const Goal & goal, Run & run, Vector3 & mean) const;
  /// Succeeds when the threshold is reached. Fails at the distance, the timeout, or another reason to stop.
  Outcome wait_for_threshold(const Goal & goal, Run & run, const Vector3 & offset) const;

  const WrenchPart part_;
};

}  // namespace ur_ros_rtde
