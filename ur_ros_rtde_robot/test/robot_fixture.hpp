#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "support.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde::test {

/// A controller and a robot side, neither started; and all that happens to them.
struct RobotFixture : testing::Test {
  Log log;
  Controller controller;
  std::mutex mutex;
  std::vector<RobotStatus> statuses;
  std::vector<std::chrono::steady_clock::time_point> status_times;  ///< of `statuses`
  std::vector<Sample> samples;                                      ///< while `recording`
  std::atomic<bool> recording{false};
  std::function<void(const Sample &)> on_sample;  ///< called on the receiving thread
  std::unique_ptr<Robot> robot;                   ///< its callbacks use what is above

  void make_robot(RobotOptions options = robot_options());
  void make_both(const RobotOptions & options = robot_options());
  /// With Controller::slow_options(): a stop takes the next means if the control program does not take its
  /// command within some control cycles.
  void make_both_slow(const RobotOptions & options = robot_options());
  /// Waits for the state; the failure message is the log.
  testing::AssertionResult comes_to(RobotState state, ErrorCode cause = ErrorCode::none,
                                    std::chrono::milliseconds timeout = 20s);
  testing::AssertionResult becomes_ready(std::chrono::milliseconds timeout = 20s)
  {
    return comes_to(RobotState::ready, {}, timeout);
  }

  /// Has become ready for the n-th time.
  testing::AssertionResult becomes_ready_again(std::size_t times = 2);

  /// A long joint motion that is well under way when this returns.
  void move_joints();
  /// The same straight up, 0.1 m/s.
  void move_linear();
  bool at_rest() const { return !robot->is_moving(); }

  /// A claim of a goal of a command.
  static Claim claim(Resource resource = Resource::motion)
  {
    return {.resource = resource, .owner = "/test", .id = "1"};
  }
  /// Fails the test without a lease.
  Lease acquire(Resource resource = Resource::motion);
  /// With a lease that lasts until the next call of a function of the fixture that needs one.
  Locked<ur_rtde::RTDEControlInterface> control();
  ScriptReport run_script(const std::string & script, const ScriptOptions & options = {});
  Status run_extension(const std::string & name, const ExtensionOptions & options = {});

  /// Highest deceleration of joint `index` (rad/s^2) in the recorded samples, by target velocities over 10
  /// ms.
  double highest_deceleration(std::size_t index);
  std::vector<Sample> recorded();
  /// Controller time of the first recorded sample in which the target of the arm is at rest, s.
  double recorded_rest();

 private:
  Lease holder_;
};

}  // namespace ur_ros_rtde::test
