#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace ur_simulator {

/// Model of a Robotiq 2F-85 gripper: its registers and the motion of its fingers (Robotiq, "2F-85 & 2F-140
/// Instruction Manual", register mapping). The position is linear in the width between the fingers. They meet
/// before the largest position that can be requested, as those of a real gripper.
class RobotiqGripper {
 public:
  static constexpr int closed_position = 227;  ///< register POS of the closed fingers (recorded); 0: open
  static constexpr double stroke = 85.0;       ///< mm
  static constexpr double min_speed = 20.0;    ///< mm/s, register SPE = 0
  static constexpr double max_speed = 150.0;   ///< mm/s, register SPE = 255
  static constexpr double min_force = 20.0;    ///< N, register FOR = 0
  static constexpr double max_force = 235.0;   ///< N, register FOR = 255

  /// Register STA.
  enum class Status { reset = 0, activating = 1, active = 3 };
  /// Register OBJ.
  enum class Contact { none = 0, opening = 1, closing = 2, at_position = 3 };

  /// Advances by one cycle. Without power, the gripper forgets its registers and does not answer.
  void step(double duration, bool powered);
  bool is_powered() const { return powered_; }

  /// The value of a register; nothing if there is none with this name.
  std::optional<int> get(std::string_view name) const;
  /// Writes a register of the requests: ACT, MOD, GTO, ATR, ARD, MSC, POS, SPE or FOR, 0 to 255. The gripper
  /// evaluates it in the next cycle; MOD and MSC have no effect. False if there is no such register, or the
  /// value is out of range.
  bool set(std::string_view name, int value);

  /// Activates the gripper without a motion, as if that had happened before.
  void set_active();
  /// Width of an object between the fingers, mm, and its stiffness, N/m; width 0: no object. The fingers
  /// compress it by force / stiffness.
  void set_object(double width, double stiffness = std::numeric_limits<double>::infinity());
  /// Stuck fingers do not move, which the gripper takes for a contact.
  void set_stuck(bool stuck) { stuck_ = stuck; }
  bool is_stuck() const { return stuck_; }
  /// A fault code of the register FLT; 0: none. From 10 on, only a reset (ACT = 0) clears it; 5
  /// and 7 end with an activation.
  void set_fault(int code) { fault_ = code; }
  double width() const;
  double object_width() const { return object_width_; }

 private:
  struct Requests {
    int activate = 0, go_to = 0, release = 0, release_closes = 0;
    int position = 0, speed = 0, force = 0;
    int mode = 0, max_current = 0;
  };

  static int Requests::* request(std::string_view name);
  void reset();
  void activate(double duration);
  void release(double duration);
  void move(double requested, double speed, double duration);
  double speed() const;
  double holding_position(int force) const;
  int fault() const;

  Requests requests_;
  int echo_ = 0;  ///< register PRE
  Status status_ = Status::reset;
  Contact contact_ = Contact::none;
  bool closed_once_ = false;  ///< of the two motions of an activation
  bool released_ = false;
  bool powered_ = false;
  bool stuck_ = false;
  int fault_ = 0;
  double position_ = 0.0;
  double object_width_ = 0.0;
  double object_stiffness_ = std::numeric_limits<double>::infinity();
};

}  // namespace ur_simulator
