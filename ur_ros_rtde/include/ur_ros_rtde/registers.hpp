#pragma once

#include <cstdint>

namespace ur_ros_rtde {

class Robot;

/// The controller's general purpose registers, as an extension's parameters and results; numbers without the
/// offset of the upper range. Throws RobotError: invalid_goal for a number that extensions may not use,
/// link_lost.
class Registers {
 public:
  explicit Registers(Robot & robot) : robot_(robot) {}

  /// Input registers 19 to 22.
  void set_int(int index, std::int32_t value);
  void set_double(int index, double value);
  /// Output registers 12 to 19 (double: not 18), of the newest package.
  std::int32_t get_int(int index) const;
  double get_double(int index) const;

 private:
  Robot & robot_;
};

}  // namespace ur_ros_rtde
