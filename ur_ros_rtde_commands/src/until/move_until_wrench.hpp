#pragma once

#include <array>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/action/move_until_force.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Moves until a part of the wrench on the TCP, its force or its torque, reaches a threshold. The measure is
/// taken from each package of the controller, so that the stop is under way two cycles after the package that
/// tells of it.
class MoveUntilWrench : public Command<ur_ros_rtde_msgs::action::MoveUntilForce> {
 public:
  struct Part {
    std::size_t first;         ///< of the wrench: 0 for the force, 3 for the torque
    double highest_threshold;  ///< N or Nm
    std::string unit;
  };

  explicit MoveUntilWrench(Part part) : part_(std::move(part)) {}

 private:
  void check(const Goal & goal, Check & check) const override;
  StopOptions stop_options(const Goal & goal) const override
  {
    return {.linear_deceleration = goal.deceleration};
  }
  Outcome run(const Goal & goal, Run & run) override;

  /// The components that count, in the goal's frame; the others are zero.
  Vector3 measure(const Goal & goal, const Sample & sample) const;
  /// What is measured while nothing moves: the mean of some packages.
  std::optional<StopReason> rest(const Goal & goal, Run & run, Vector3 & mean) const;
  /// Looks at each package until the threshold; a failure when there is another reason to stop.
  Outcome watch(const Goal & goal, Run & run, const Vector3 & zero) const;

  const Part part_;
};

}  // namespace ur_ros_rtde
