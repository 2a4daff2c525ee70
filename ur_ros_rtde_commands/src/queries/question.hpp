#pragma once

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// A command that only asks: needs nothing for itself, and so may run beside a motion.
template <typename A>
class Question : public Command<A> {
 public:
  CommandTraits traits() const override { return {.resource = Resource::none}; }
};

/// Has ur_rtde wait for an answer no longer than this; by default it waits for minutes.
class AnswerLimit {
 public:
  explicit AnswerLimit(ur_rtde::RTDEControlInterface & control) : control_(control)
  {
    control_.setCommandTimeout(std::chrono::seconds(2));
  }
  ~AnswerLimit() { control_.setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT)); }
  AnswerLimit(const AnswerLimit &) = delete;
  AnswerLimit & operator=(const AnswerLimit &) = delete;

 private:
  ur_rtde::RTDEControlInterface & control_;
};

/// What `ask` gets from ur_rtde's control interface, which it is given. The control program answers between
/// two of its cycles, also while it moves the arm; the interface is locked meanwhile. Throws RobotError when
/// no answer comes: with what keeps the robot from answering, or rejected_by_robot.
template <typename Ask>
auto answer(Run & run, Ask && ask)
{
  const auto control = run.control().hold();
  const AnswerLimit limit(*control);
  try {
    return std::forward<Ask>(ask)(*control);
  } catch (const std::logic_error & error) {
    if (run.robot().register_offset() == 0) {
      throw;
    }
    throw RobotError({ErrorCode::not_supported,
                      fmt::format("with register_range: upper this cannot be asked: {}", error.what())});
  } catch (const std::runtime_error & error) {
    if (const Status possible = run.robot().motion_possible(); !possible) {
      throw RobotError(possible.error());
    }
    throw RobotError({ErrorCode::rejected_by_robot,
                      fmt::format("the control program on the robot did not answer: {}", error.what())});
  }
}

/// ur_rtde gives what it could not ask for as an empty vector.
std::array<double, 6> six(const std::vector<double> & values);
/// The 36 values of a matrix that ur_rtde has by columns, by rows.
std::array<double, 36> by_rows(const std::vector<double> & columns);
/// A pose of ur_rtde.
geometry_msgs::msg::Pose to_pose(const std::vector<double> & pose);

/// A field that may be left empty: `values`, or what the newest package says.
std::vector<double> or_present(const std::vector<double> & values, const Vector6 & present);
/// `tcp`, or the active one when the goal gives none.
std::vector<double> tcp_of(ur_rtde::RTDEControlInterface & control, bool given,
                           const geometry_msgs::msg::Pose & tcp);

/// Joint positions, or none.
Check & joints_or_none(Check & check, std::string_view field, const std::vector<double> & values);
/// Joint velocities, each within 10 rad/s, or none.
Check & velocities_or_none(Check & check, std::string_view field, const std::vector<double> & values);
/// The TCP of a goal that may give one.
Check & tcp_if(Check & check, bool given, const geometry_msgs::msg::Pose & tcp);

}  // namespace ur_ros_rtde
