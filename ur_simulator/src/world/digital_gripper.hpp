#pragma once

#include "state/controller_state.hpp"

namespace ur_simulator {

/// Model of a pneumatic gripper at the tool connector. Tool output 0 closes it; the fingers of a
/// double-acting gripper need tool output 1 to open, a spring opens those of a single-acting one. Tool input
/// 0 reports that the fingers have stopped at an object, tool input 1 that they are open. Its valves and
/// sensors need 24 V.
class DigitalGripper {
 public:
  static constexpr double stroke = 40.0;  ///< mm
  static constexpr double speed = 100.0;  ///< mm/s

  explicit DigitalGripper(bool double_acting) : double_acting_(double_acting) {}
  /// Advances by one cycle: reads the outputs and writes the inputs.
  void step(double duration, Io & io);
  double width() const { return width_; }

  /// Without compressed air, the fingers do not move.
  void set_air(bool air) { air_ = air; }
  bool air() const { return air_; }
  /// Width of an object between the fingers, mm; 0: no object.
  void set_object(double width) { object_ = width; }
  double object() const { return object_; }

 private:
  bool double_acting_;
  bool air_ = true;
  double width_ = stroke;
  double object_ = 0.0;
};

}  // namespace ur_simulator
