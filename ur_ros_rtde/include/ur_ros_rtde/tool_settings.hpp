#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// How long it may take until the state of the robot contains a new setting.
constexpr std::chrono::seconds setting_timeout{1};

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

/// A setting that lasts as long as this object exists. Its destructor stops the arm and puts the setting
/// before back, also after a cancel or if the new one was not confirmed; a failure is a warning of the goal.
///
///     const TemporarySetting payload = temporary_payload(run, 2.0, {0.0, 0.0, 0.05});
class [[nodiscard]] TemporarySetting {
 public:
  using PutBack = std::function<bool(ur_rtde::RTDEControlInterface &)>;

  /// Throws RobotError with the reason if `set` fails. `name`: "the payload".
  TemporarySetting(Run & run, std::string name, const std::function<Outcome()> & set, PutBack put_back);
  ~TemporarySetting();
  TemporarySetting(const TemporarySetting &) = delete;
  TemporarySetting & operator=(const TemporarySetting &) = delete;
  /// The setting before is not put back.
  void keep() { put_back_ = nullptr; }

 private:
  TemporarySetting(Run & run, std::string name, PutBack put_back)
      : run_(run), name_(std::move(name)), put_back_(std::move(put_back))
  {
  }

  Run & run_;
  const std::string name_;
  PutBack put_back_;
};

/// As set_payload() and set_tcp(). For a part that may still be in the gripper at the end, use set_payload(),
/// or keep(). Throws RobotError (not_supported) if the robot does not report the payload before.
TemporarySetting temporary_payload(Run & run, double mass, const Vector3 & center_of_gravity);
TemporarySetting temporary_tcp(Run & run, const std::vector<double> & offset);

}  // namespace ur_ros_rtde
