#pragma once

#include <cstdint>

namespace ur_simulator {

/// Model of an OnRobot soft gripper, which opens and closes to a width at a finite speed. Limits: data sheet
/// of the SG-a (11 to 75 mm); speeds are estimates.
class SoftGripper {
 public:
  static constexpr double min_width = 11.0;     ///< mm
  static constexpr double max_width = 75.0;     ///< mm
  static constexpr double speed = 60.0;         ///< mm/s
  static constexpr double gentle_speed = 20.0;  ///< mm/s

  /// Advances by one cycle.
  void step(double duration);
  /// The target is clamped to the limits.
  void move_to(double width, bool gentle);
  double width() const { return width_; }
  double target() const { return target_; }
  bool is_busy() const { return width_ != target_ || stuck_; }

  /// A stuck gripper stops and stays busy, as without compressed air.
  void set_stuck(bool stuck) { stuck_ = stuck; }
  bool is_stuck() const { return stuck_; }
  /// Without power, the URCap does not reach the gripper.
  void set_powered(bool powered) { powered_ = powered; }
  bool is_powered() const { return powered_; }
  /// Width of an object between the fingers, mm, which limits closing; 0: no object.
  void set_object(double width) { object_ = width; }
  bool holds_object() const { return object_ > 0.0 && width_ == object_; }

 private:
  double width_ = 40.0;
  double target_ = 40.0;
  double object_ = 0.0;
  bool gentle_ = false;
  bool stuck_ = false;
  bool powered_ = true;
};

}  // namespace ur_simulator
