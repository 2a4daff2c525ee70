#pragma once

#include <array>
#include <functional>
#include <geometry_msgs/msg/point.hpp>
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

/// A check that waits for an answer of the robot.
using RobotQuery = std::function<Status(Robot &)>;

/// Checks a goal before it is accepted. Each function checks one thing. The first failure becomes the error,
/// and later functions do nothing. Messages name the field, the value and the limit.
///
///     check.joints("joint_positions", goal.joint_positions);
///     check.above_zero("speed", goal.speed, 3.14, "rad/s");
class Check {
 public:
  /// Without a robot, checks that need it succeed. `prepare`: success if the robot can execute the command
  /// now and no other goal is in the way.
  explicit Check(Robot * robot = nullptr, std::function<Status()> prepare = {})
      : robot_(robot), prepare_(std::move(prepare))
  {
  }

  // Numbers and texts

  /// Finite, and low <= value <= high.
  Check & in_range(std::string_view field, double value, double low, double high, std::string_view unit = "");
  /// Finite, and 0 < value <= high.
  Check & above_zero(std::string_view field, double value, double high, std::string_view unit = "");
  /// One line of text without control characters, 1 to `longest` bytes.
  Check & line(std::string_view field, std::string_view text, std::size_t longest);
  /// Any other condition. `message`: the error if it does not hold.
  Check & that(bool holds, std::string message, ErrorCode code = ErrorCode::invalid_goal);

  // Joints

  /// Six finite values within the position limits of the arm, rad.
  Check & joints(std::string_view field, const std::vector<double> & values);
  /// Six finite values, the magnitude of each at most the limit of its joint.
  Check & each_joint(std::string_view field, const std::vector<double> & values, const Vector6 & limits,
                     std::string_view unit);
  /// As each_joint(), with the velocity limits of the arm and at most 3.14 rad/s; not all zero.
  Check & joint_velocities(std::string_view field, const std::vector<double> & values);
  /// Six finite values within the torque limits of the arm, Nm.
  Check & joint_torques(std::string_view field, const std::vector<double> & values);

  // Poses and vectors

  /// Finite position within reach, and a quaternion that can be normalized.
  Check & pose(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// Finite and within reach.
  Check & position(std::string_view field, const geometry_msgs::msg::Point & position);
  /// As pose(), for a pose that the arm need not reach: a task frame, a TCP.
  Check & frame(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// Each component is finite and its magnitude is at most `limit`.
  Check & vector(std::string_view field, const geometry_msgs::msg::Vector3 & vector, double limit,
                 std::string_view unit = "");
  /// |linear| <= 3 m/s, |angular| <= 3.14 rad/s, not both zero.
  Check & twist(std::string_view field, const geometry_msgs::msg::Twist & twist);

  // State of the robot

  /// The robot can execute this command now, and no other goal is in the way. The checks below include it.
  Check & ready();
  /// PolyScope 5.`minor` or later; on a CB3 controller 3.`cb3_minor` or later. Without `cb3_minor`, no CB3
  /// controller is sufficient.
  Check & polyscope(unsigned minor, std::optional<unsigned> cb3_minor = std::nullopt);
  /// The control program can answer queries. For commands without a resource: the arm may be moving.
  Check & answers_queries();
  /// The controller finds a solution for the pose within the safety limits. Skipped while the arm moves,
  /// because the inverse kinematics would start from a moving configuration.
  Check & reachable(std::string_view field, const geometry_msgs::msg::Pose & pose);
  /// The same for a UR pose: position (m) and rotation vector (rad).
  Check & reachable(std::string_view field, const std::vector<double> & pose);
  /// Calls `query` after all other checks have succeeded, in a thread that may wait for the robot. The goal
  /// is accepted or rejected when the last query has returned.
  Check & query(RobotQuery query);
  /// The state in which the motion will start: the newest sample. Empty after a failure, and while the arm
  /// still moves because another motion is being preempted.
  std::optional<Sample> start();
  /// No joint exceeds its velocity limit on the way to `positions` in `time` (s), if its peak velocity is
  /// `peak` times the mean velocity.
  Check & reachable_in(std::string_view field, const std::vector<double> & positions, double time,
                       double peak);

  // Outcome of the checks

  /// None has failed so far.
  bool ok() const { return !error_; }
  /// The first failure.
  const std::optional<Error> & error() const { return error_; }
  /// The first failure, also of the queries, which are called here: waits for the robot.
  Status ask(Robot & robot);
  /// The queries in the order of their calls.
  std::vector<RobotQuery> take_queries() { return std::move(queries_); }

 private:
  void fail(ErrorCode code, std::string message);
  ArmLimits limits() const;
  std::optional<Sample> newest();

  Robot * robot_;
  std::function<Status()> prepare_;
  std::optional<Error> error_;
  std::vector<RobotQuery> queries_;
};

/// Converts a pose of a goal to a UR pose: position (m) and rotation vector (rad). Throws RobotError
/// (invalid_goal) for a quaternion that cannot be normalized.
std::vector<double> to_ur(const geometry_msgs::msg::Pose & pose);
/// Linear part (m/s), then angular part (rad/s).
std::vector<double> to_ur(const geometry_msgs::msg::Twist & twist);
/// Converts a UR pose to a pose of a result or feedback.
geometry_msgs::msg::Pose to_ros(const Vector6 & pose);

/// "shoulder_pan_joint", … in the order of ur_rtde.
const std::array<std::string, 6> & joint_names();

}  // namespace ur_ros_rtde
