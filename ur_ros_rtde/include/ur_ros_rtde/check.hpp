#pragma once

#include <array>
#include <geometry_msgs/msg/pose.hpp>
#include <geometry_msgs/msg/twist.hpp>
#include <geometry_msgs/msg/vector3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

class Robot;

/// What a check may ask the robot; the base class of the commands provides it.
class Preflight {
 public:
  virtual ~Preflight() = default;
  /// The robot takes this command now, and nothing else is in its way.
  virtual Status prepare() = 0;
  virtual ArmLimits limits() const = 0;
  virtual Robot & robot() = 0;
};

/// Looks at a goal before it is accepted. Each function looks at one thing; the first that is wrong becomes
/// the error, and the functions after it do nothing. Messages name field, value and limit.
///
///     check.joints("joint_positions", goal.joint_positions);
///     check.above_zero("speed", goal.speed, 3.14, "rad/s");
class Check {
 public:
  /// Without `preflight`, what concerns the robot passes.
  explicit Check(Preflight * preflight = nullptr) : preflight_(preflight) {}

  /// Six finite values within the position limits of the arm. rad
  Check & joints(std::string_view field, const std::vector<double> & values);
  Check & in_range(std::string_view field, double value, double low, double high, std::string_view unit = "");
  /// 0 < value <= high
  Check & above_zero(std::string_view field, double value, double high, std::string_view unit = "");
  /// Finite; a quaternion that has a direction.
  Check & pose(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// The same for one that the arm need not reach: a frame, a TCP.
  Check & frame(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// Each component finite and at most `limit` in size.
  Check & vector(std::string_view field, const geometry_msgs::msg::Vector3 & vector, double limit,
                 std::string_view unit = "");
  /// |linear| <= 3 m/s, |angular| <= 3.14 rad/s, not both zero.
  Check & twist(std::string_view field, const geometry_msgs::msg::Twist & twist);
  /// Six finite values, one a joint, each at most `limits` of its joint in size.
  Check & each_joint(std::string_view field, const std::vector<double> & values, const Vector6 & limits,
                     std::string_view unit);
  /// The same: each at most 3.14 rad/s and what its joint can; not all zero.
  Check & joint_velocities(std::string_view field, const std::vector<double> & values);
  /// Not empty, one line, no control characters, at most `longest` bytes.
  Check & line(std::string_view field, std::string_view text, std::size_t longest);
  Check & that(bool holds, std::string message, ErrorCode code = ErrorCode::invalid_goal);

  /// From here on the robot is asked: it takes this command now, and nothing else is in its way.
  Check & ready();
  /// The controller's PolyScope is at least 5.`minor`; on a CB3 3.`cb3_minor`, none: no CB3 will do.
  Check & polyscope(unsigned minor, std::optional<unsigned> cb3_minor = std::nullopt);
  /// The control program answers questions now. For what needs no resource: it may move the arm meanwhile.
  Check & answers();
  /// The arm can get the TCP there from where it is, within its safety limits: the controller answers. Some
  /// milliseconds.
  Check & reachable(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// The same for a pose of UR: position (m) and rotation vector (rad).
  Check & reachable(std::string_view field, const std::vector<double> & pose);
  /// Where a motion that is accepted now begins: the newest package. None when something has failed, and
  /// while the arm still moves, because another motion is being preempted.
  std::optional<Sample> start();
  /// No joint has to go faster than it can on the way to `positions` in `time`, when its highest speed is
  /// `peak` times the mean one.
  Check & reachable_in(std::string_view field, const std::vector<double> & positions, double time,
                       double peak);

  bool ok() const { return !error_; }
  const std::optional<Error> & error() const { return error_; }

 private:
  void fail(ErrorCode code, std::string message);
  ArmLimits limits() const;
  std::optional<Sample> newest();

  Preflight * preflight_;
  std::optional<Error> error_;
};

/// A field of a goal that is a pose, for ur_rtde: position (m) and rotation vector (rad). Throws RobotError
/// (invalid_goal) for a quaternion without a direction.
std::vector<double> to_ur(const geometry_msgs::msg::Pose & pose);
std::vector<double> to_ur(const geometry_msgs::msg::Twist & twist);
/// A pose of UR, for a field of a result or of feedback.
geometry_msgs::msg::Pose to_ros(const Vector6 & pose);

/// "shoulder_pan_joint", … in the order of ur_rtde.
const std::array<std::string, 6> & joint_names();

}  // namespace ur_ros_rtde
