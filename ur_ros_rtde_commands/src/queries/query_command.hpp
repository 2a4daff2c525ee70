#pragma once

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// A command that only reads from the robot. It may run during a motion.
template <typename A>
class QueryCommand : public Command<A> {
 public:
  CommandTraits traits() const override { return {.resource = Resource::none}; }
};

/// Reduces the time that ur_rtde waits for an answer from minutes to 2 s, during its own lifetime.
class AnswerTimeout {
 public:
  explicit AnswerTimeout(ur_rtde::RTDEControlInterface & control) : control_(control)
  {
    control_.setCommandTimeout(std::chrono::seconds(2));
  }
  ~AnswerTimeout() { control_.setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT)); }
  AnswerTimeout(const AnswerTimeout &) = delete;
  AnswerTimeout & operator=(const AnswerTimeout &) = delete;

 private:
  ur_rtde::RTDEControlInterface & control_;
};

/// Calls `function` with ur_rtde's control interface and returns its result. The control program answers
/// between two of its cycles, also during a motion. The interface is locked in the meantime. Without an
/// answer, throws RobotError with the reason why the goal has to end, or why the robot cannot answer, or
/// rejected_by_robot.
template <typename Function>
auto query(Run & run, Function && function)
{
  const auto control = run.control().hold();
  const AnswerTimeout timeout(*control);
  try {
    return std::forward<Function>(function)(*control);
  } catch (const std::logic_error & error) {
    if (run.robot().register_offset() == 0) {
      throw;
    }
    throw RobotError({ErrorCode::not_supported,
                      fmt::format("not available with register_range: upper: {}", error.what())});
  } catch (const std::runtime_error & error) {
    if (const auto why = run.stop_reason()) {
      throw RobotError(*why);
    }
    if (const Status possible = run.robot().motion_possible(); !possible) {
      throw RobotError(possible.error());
    }
    throw RobotError({ErrorCode::rejected_by_robot,
                      fmt::format("the control program on the robot did not answer: {}", error.what())});
  }
}

/// Throws std::runtime_error unless there are 6 values.
std::array<double, 6> to_array6(const std::vector<double> & values);
/// Converts a 6x6 matrix from the column-major order of ur_rtde to row-major order.
std::array<double, 36> to_row_major(const std::vector<double> & columns);
/// Converts a UR pose.
geometry_msgs::msg::Pose to_pose(const std::vector<double> & pose);

/// The values of an optional field, or the current ones if it is empty.
std::vector<double> or_current(const std::vector<double> & values, const Vector6 & current);
/// `tcp` if the goal gives one, otherwise the active TCP offset.
std::vector<double> tcp_or_active(ur_rtde::RTDEControlInterface & control, bool given,
                                  const geometry_msgs::msg::Pose & tcp);

/// Checks joint positions unless the field is empty.
Check & check_optional_joints(Check & check, std::string_view field, const std::vector<double> & values);
/// Checks joint velocities (at most 10 rad/s) unless the field is empty.
Check & check_optional_velocities(Check & check, std::string_view field, const std::vector<double> & values);
/// Checks the TCP if the goal gives one.
Check & check_optional_tcp(Check & check, bool given, const geometry_msgs::msg::Pose & tcp);

}  // namespace ur_ros_rtde
