#pragma once

#include <vector>

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Sets the payload and waits until the robot reports it, which controllers before PolyScope 5.5 do not.
/// `mass`: kg; `center_of_gravity`: m, in the flange frame. Throws RobotError (rejected_by_robot) if the
/// control program did not set it.
[[nodiscard]] Outcome set_payload(Run & run, double mass, const Vector3 & center_of_gravity);
/// The robot reports this payload, or reports none.
bool has_payload(const Sample & sample, double mass, const Vector3 & center_of_gravity);
/// For ur_rtde, whose control script keeps the previous center of gravity if the new one is exactly zero:
/// zero becomes 1 nm.
std::vector<double> to_ur_center_of_gravity(const Vector3 & center_of_gravity);

/// Sets the TCP, a UR pose in the flange frame (m, rad), and waits until the robot reports it. Throws as
/// above.
[[nodiscard]] Outcome set_tcp(Run & run, const std::vector<double> & offset);

/// A payload as long as this object exists. Its destructor waits until the arm is at rest and sets the one
/// before, also when the goal was canceled; a failure is a warning of the goal. For a part that may still be
/// in the gripper then, use set_payload(), or keep().
class [[nodiscard]] TemporaryPayload {
 public:
  /// As set_payload(). Throws RobotError with the reason also if the robot does not report it in time, or
  /// does not report the one before (not_supported).
  TemporaryPayload(Run & run, double mass, const Vector3 & center_of_gravity);
  ~TemporaryPayload();
  TemporaryPayload(const TemporaryPayload &) = delete;
  TemporaryPayload & operator=(const TemporaryPayload &) = delete;
  /// The payload is not put back.
  void keep() { keeps_ = true; }

 private:
  Run & run_;
  const double mass_before_;
  const Vector3 center_of_gravity_before_;
  bool keeps_ = false;
};

/// The same for the TCP.
class [[nodiscard]] TemporaryTcp {
 public:
  TemporaryTcp(Run & run, const std::vector<double> & offset);
  ~TemporaryTcp();
  TemporaryTcp(const TemporaryTcp &) = delete;
  TemporaryTcp & operator=(const TemporaryTcp &) = delete;
  /// The TCP is not put back.
  void keep() { keeps_ = true; }

 private:
  Run & run_;
  const std::vector<double> before_;
  bool keeps_ = false;
};

}  // namespace ur_ros_rtde
