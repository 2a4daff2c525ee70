#include "ur_ros_rtde/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/connection/interfaces.hpp"
#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde {
namespace {
std::string with_unit(std::string_view unit)
{
  return unit.empty() ? std::string() : fmt::format(" {}", unit);
}

template <typename Vector>
double length_of(const Vector & v)
{
  return length(v.x, v.y, v.z);
}

Expected<Vector3> rotation_vector_of(const geometry_msgs::msg::Pose & pose)
{
  const auto & q = pose.orientation;
  return rotation_vector(Quaternion{q.x, q.y, q.z, q.w});
}

/// get_inverse_kin_has_solution exists from PolyScope 5.10 and 3.15 on (UR, Script Manual).
bool tells_solvability(const Robot & robot)
{
  const auto version = robot.version();
  return !version || (version->cb3() ? version->minor >= 15 : version->major > 5 || version->minor >= 10);
}

Status check_reachable(Robot & robot, const std::string & field, const std::vector<double> & target)
{
  const std::string where =
      fmt::format("{} ({:.3f}, {:.3f}, {:.3f}) m", field, target[0], target[1], target[2]);
  try {
    if (robot.control_for_queries()->isPoseWithinSafetyLimits(target)) {
      return {};
    }
    if (!tells_solvability(robot)) {
      return failure(ErrorCode::unreachable,
                     fmt::format("{} cannot be reached in this orientation, or is outside the robot's safety "
                                 "limits",
                                 where));
    }
    if (robot.control_for_queries()->getInverseKinematicsHasSolution(target)) {
      return failure(ErrorCode::safety_violation,
                     fmt::format("{} is outside the robot's safety limits", where));
    }
    return failure(
        ErrorCode::unreachable,
        fmt::format("{} cannot be reached in this orientation: the inverse kinematics has no solution",
                    where));
  } catch (const RobotError &) {
    throw;
  } catch (const std::runtime_error & error) {
    if (const Status possible = robot.motion_possible(); !possible) {
      return possible;
    }
    return failure(
        ErrorCode::rejected_by_robot,
        fmt::format("the control program did not answer whether {} can be reached: {}", where, error.what()));
  }
}
}  // namespace

const std::array<std::string, 6> & joint_names()
{
  static const auto names = [] {
    std::array<std::string, 6> all;
    for (int joint = 0; joint < trajectory::joint_count; ++joint) {
      all[static_cast<std::size_t>(joint)] = trajectory::joint_name(joint);
    }
    return all;
  }();
  return names;
}

std::vector<double> to_ur(const geometry_msgs::msg::Pose & pose)
{
  const auto rotation = rotation_vector_of(pose);
  if (!rotation) {
    throw RobotError(rotation.error());
  }
  return {pose.position.x, pose.position.y, pose.position.z, (*rotation)[0], (*rotation)[1], (*rotation)[2]};
}

std::vector<double> to_ur(const geometry_msgs::msg::Twist & twist)
{
  return {twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z};
}

geometry_msgs::msg::Pose to_ros(const Vector6 & pose)
{
  const Quaternion q = quaternion(rotation(pose));
  geometry_msgs::msg::Pose message;
  message.position.x = pose[0];
  message.position.y = pose[1];
  message.position.z = pose[2];
  message.orientation.x = q.x;
  message.orientation.y = q.y;
  message.orientation.z = q.z;
  message.orientation.w = q.w;
  return message;
}

void Check::fail(ErrorCode code, std::string message)
{
  error_ = Error{code, std::move(message)};
}

ArmLimits Check::limits() const
{
  return robot_ != nullptr ? robot_->limits() : widest_arm_limits();
}

Check & Check::that(bool holds, std::string message, ErrorCode code)
{
  if (ok() && !holds) {
    fail(code, std::move(message));
  }
  return *this;
}

Check & Check::each_joint(std::string_view field, const std::vector<double> & values, const Vector6 & limits,
                          std::string_view unit)
{
  that(values.size() == 6, fmt::format("{} has {} values, it must have 6: {}", field, values.size(),
                                       fmt::join(joint_names(), ", ")));
  for (std::size_t i = 0; i < 6 && ok(); ++i) {
    in_range(fmt::format("{}[{}] ({})", field, i, joint_names()[i]), values[i], -limits[i], limits[i], unit);
  }
  return *this;
}

Check & Check::joints(std::string_view field, const std::vector<double> & values)
{
  return each_joint(field, values, limits().position, "rad");
}

Check & Check::joint_velocities(std::string_view field, const std::vector<double> & values)
{
  constexpr double highest = 3.14;  // limit of ur_rtde
  Vector6 velocity = limits().velocity;
  for (double & limit : velocity) {
    limit = std::min(limit, highest);
  }
  return each_joint(field, values, velocity, "rad/s")
      .that(std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; }),
            fmt::format("{} is zero: nothing would move", field));
}

Check & Check::joint_torques(std::string_view field, const std::vector<double> & values)
{
  return each_joint(field, values, limits().torque, "Nm");
}

Check & Check::in_range(std::string_view field, double value, double low, double high, std::string_view unit)
{
  if (ok() && !(std::isfinite(value) && value >= low && value <= high)) {
    fail(ErrorCode::invalid_goal, fmt::format("{} is {:.6g}{}, it may be {:.6g} to {:.6g}{}", field, value,
                                              with_unit(unit), low, high, with_unit(unit)));
  }
  return *this;
}

Check & Check::above_zero(std::string_view field, double value, double high, std::string_view unit)
{
  if (ok() && !(std::isfinite(value) && value > 0.0 && value <= high)) {
    fail(ErrorCode::invalid_goal, fmt::format("{} is {:.6g}{}, it must be above 0 and at most {:.6g}{}",
                                              field, value, with_unit(unit), high, with_unit(unit)));
  }
  return *this;
}

Check & Check::pose(std::string_view field, const geometry_msgs::msg::Pose & pose)
{
  position(field, pose.position);
  if (const auto rotation = rotation_vector_of(pose); ok() && !rotation) {
    fail(ErrorCode::invalid_goal, fmt::format("{}.orientation: {}", field, rotation.error().message));
  }
  return *this;
}

Check & Check::position(std::string_view field, const geometry_msgs::msg::Point & position)
{
  const double reach = limits().reach;
  const double distance = length_of(position);
  that(std::isfinite(distance), fmt::format("{}.position is ({}, {}, {}) m, it must be finite", field,
                                            position.x, position.y, position.z));
  if (ok() && distance > reach + 1.0) {  // a tool may add a metre
    fail(ErrorCode::unreachable,
         fmt::format("{}.position is {:.3f} m from the base, the arm reaches {:.3f} m without its tool",
                     field, distance, reach));
  }
  return *this;
}

Check & Check::vector(std::string_view field, const geometry_msgs::msg::Vector3 & vector, double limit,
                      std::string_view unit)
{
  return in_range(fmt::format("{}.x", field), vector.x, -limit, limit, unit)
      .in_range(fmt::format("{}.y", field), vector.y, -limit, limit, unit)
      .in_range(fmt::format("{}.z", field), vector.z, -limit, limit, unit);
}

Check & Check::twist(std::string_view field, const geometry_msgs::msg::Twist & twist)
{
  return in_range(fmt::format("the length of {}.linear", field), length_of(twist.linear), 0.0, 3.0, "m/s")
      .in_range(fmt::format("the length of {}.angular", field), length_of(twist.angular), 0.0, 3.14, "rad/s")
      .that(length_of(twist.linear) > 0.0 || length_of(twist.angular) > 0.0,
            fmt::format("{} is zero: nothing would move", field));
}

Check & Check::line(std::string_view field, std::string_view text, std::size_t longest)
{
  if (!ok()) {
    return *this;
  }
  if (text.empty() || text.size() > longest) {
    fail(ErrorCode::invalid_goal,
         fmt::format("{} has {} bytes, it may have 1 to {}", field, text.size(), longest));
    return *this;
  }
  const auto control = std::find_if(text.begin(), text.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (control != text.end()) {
    fail(ErrorCode::invalid_goal,
         fmt::format("{} has a control character (0x{:02x}) at byte {}, it must be one line of text", field,
                     static_cast<unsigned>(static_cast<unsigned char>(*control)), control - text.begin()));
  }
  return *this;
}

Check & Check::ready()
{
  if (ok() && prepare_) {
    if (Status status = prepare_(); !status) {
      error_ = status.error();
    }
  }
  return *this;
}

Check & Check::reachable(std::string_view field, const geometry_msgs::msg::Pose & pose)
{
  return ok() ? reachable(field, to_ur(pose)) : *this;
}

Check & Check::reachable(std::string_view field, const std::vector<double> & target)
{
  if (!ready().ok() || robot_ == nullptr || robot_->is_moving()) {
    return *this;
  }
  return query([pose = target, field_name = std::string(field)](Robot & robot) {
    return check_reachable(robot, field_name, pose);
  });
}

Check & Check::query(RobotQuery query)
{
  if (ok()) {
    queries_.push_back(std::move(query));
  }
  return *this;
}

Status Check::ask(Robot & robot)
{
  Status result = ok() ? Status() : tl::unexpected(*error_);
  for (const RobotQuery & query : take_queries()) {
    if (result) {
      result = query(robot);
    }
  }
  return result;
}

std::optional<Sample> Check::newest()
{
  if (!ready().ok() || robot_ == nullptr) {
    return std::nullopt;
  }
  auto sample = robot_->latest();
  that(sample.has_value(), "no data has been received from the controller yet: try again",
       ErrorCode::not_ready);
  return sample;
}

std::optional<Sample> Check::start()
{
  const auto sample = newest();
  return sample && !robot_->is_moving() ? sample : std::nullopt;
}

Check & Check::reachable_in(std::string_view field, const std::vector<double> & positions, double time,
                            double peak)
{
  const auto sample = newest();
  if (!sample) {
    return *this;
  }
  const ArmLimits arm = limits();
  for (std::size_t i = 0; i < 6 && ok(); ++i) {
    const double angle = std::abs(positions[i] - sample->actual_q[i]);
    const double needed = peak * angle / time;
    that(needed <= arm.velocity[i],
         fmt::format(
             "{}[{}] ({}) would need {:.3f} rad/s to get there in {:.3f} s, its limit is {:.3f} rad/s: "
             "use a time of at least {:.3f} s",
             field, i, joint_names()[i], needed, time, arm.velocity[i], peak * angle / arm.velocity[i]));
  }
  return *this;
}

}  // namespace ur_ros_rtde
