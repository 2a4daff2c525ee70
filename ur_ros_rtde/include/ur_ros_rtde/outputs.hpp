#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// The newest values of RTDE outputs, also of those that a Sample does not contain, over a connection of its
/// own. Values that are read with one call belong to one control cycle; "timestamp" is
/// Sample::controller_time. Thread-safe.
///
///     const Outputs outputs(run.robot(), {"tool_analog_input0"});
///     return run.expect([&] { return outputs.number("tool_analog_input0") > 4.0; }, 5s, "no part");
class Outputs {
 public:
  /// `names`: as in UR's "RTDE Guide", "Robot controller outputs". `frequency`: Hz; 0: the controller's
  /// maximum. Connects and waits for the first package, at most 2 s. Throws RobotError: invalid_goal for what
  /// is not an output, not_supported for what this controller does not have, link_lost.
  Outputs(const Robot & robot, const std::vector<std::string> & names, double frequency = 0.0);
  Outputs(const Outputs &) = delete;
  Outputs & operator=(const Outputs &) = delete;

  /// Units, frames and bits as in the "RTDE Guide"; BOOL is 0 or 1. These functions throw RobotError:
  /// link_lost after the connection was lost, invalid_goal for a name that was not asked for, or whose number
  /// of values is another one.
  double number(std::string_view name) const { return read({name}).front(); }
  std::vector<double> vector(std::string_view name) const;
  /// One value for each name.
  std::vector<double> read(const std::vector<std::string_view> & names) const;

 private:
  struct Place {
    std::size_t first;
    std::size_t count;
  };
  Place find(std::string_view name) const;
  std::vector<double> newest() const;
  void receive(const std::stop_token & stop);

  RtdeSubscription subscription_;
  std::vector<double> incoming_;
  mutable std::mutex mutex_;
  std::vector<double> values_;
  std::optional<Error> lost_;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
