#pragma once

#include <cstdint>

namespace ur_ros_rtde {

class Robot;

/// General purpose registers of the controller, which carry the parameters and results of an extension.
/// Register numbers do not include the offset of the upper range. Functions throw RobotError: invalid_goal
/// for a register that extensions may not use, link_lost without a connection.
class Registers {
 public:
  explicit Registers(Robot & robot) : robot_(robot) {}

  /// Input registers 19 to 22.
  void set_int(int index, std::int32_t value);
  void set_double(int index, double value);
  /// Output registers 12 to 19 (double: 13 to 19 without 18) of the newest sample.
  std::int32_t get_int(int index) const;
  double get_double(int index) const;

 private:
  Robot & robot_;
};

}  // namespace ur_ros_rtde
