#pragma once

#include <cstdint>

namespace ur_simulator {

/// An OnRobot soft gripper: its cups open and close to a width, mm, at a finite speed. Ours in place of the
/// device; speeds and limits are estimates by its data sheet (SG-a: 11-75 mm).
class SoftGripper {
 public:
  static constexpr double narrowest = 11.0;     ///< mm
  static constexpr double widest = 75.0;        ///< mm
  static constexpr double speed = 60.0;         ///< mm/s
  static constexpr double gentle_speed = 20.0;  ///< mm/s

  /// One cycle further.
  void step(double duration);
  /// The target is kept within the limits.
  void move_to(double width, bool gentle);
  double width() const { return width_; }
  double target() const { return target_; }
  bool busy() const { return width_ != target_ || stuck_; }

  /// As a gripper whose air is gone: it stops where it is and never says that it is done.
  void set_stuck(bool stuck) { stuck_ = stuck; }
  bool stuck() const { return stuck_; }
  /// Something between the cups: they close no further than this, mm; 0 is nothing.
  void set_object(double width) { object_ = width; }
  bool holds_object() const { return object_ > 0.0 && width_ == object_; }

 private:
  double width_ = 40.0;
  double target_ = 40.0;
  double object_ = 0.0;
  bool gentle_ = false;
  bool stuck_ = false;
};

}  // namespace ur_simulator
