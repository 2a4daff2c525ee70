#pragma once

#include <cstdint>

namespace ur_ros_rtde {

/// Something that the driver has started on the robot and that moves the arm, or lets it be moved, until it
/// ends or is ended.
enum class Activity : std::uint32_t {
  joint_move = 1U << 0U,   ///< moveJ
  linear_move = 1U << 1U,  ///< moveL, paths, the motion of an asynchronous stop
  joint_speed = 1U << 2U,
  linear_speed = 1U << 3U,
  joint_servo = 1U << 4U,    ///< servoJ
  linear_servo = 1U << 14U,  ///< servoL, servoC
  jog = 1U << 5U,
  torque = 1U << 6U,
  extension = 1U << 7U,
  script = 1U << 8U,  ///< a program in place of the control program
  force_mode = 1U << 9U,
  freedrive = 1U << 10U,
  teach_mode = 1U << 11U,
  contact_detection = 1U << 12U,  ///< startContactDetection: a contact moves the arm
  call =
      1U
      << 13U,  ///< under way, of a holder whose permit was revoked after it began: it may start any of these
};

/// A set of activities.
class Activities {
 public:
  constexpr Activities() = default;
  constexpr Activities(Activity activity) : bits_(static_cast<std::uint32_t>(activity)) {}

  constexpr bool empty() const { return bits_ == 0; }
  constexpr bool contains(Activity activity) const
  {
    return (bits_ & static_cast<std::uint32_t>(activity)) != 0;
  }
  constexpr bool contains_any(Activities others) const { return (bits_ & others.bits_) != 0; }
  constexpr Activities without(Activities others) const { return Activities(bits_ & ~others.bits_); }
  constexpr Activities operator|(Activities other) const { return Activities(bits_ | other.bits_); }
  constexpr Activities operator&(Activities other) const { return Activities(bits_ & other.bits_); }
  constexpr bool operator==(const Activities &) const = default;

 private:
  explicit constexpr Activities(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

constexpr Activities operator|(Activity a, Activity b)
{
  return Activities(a) | Activities(b);
}

/// In these, an operator moves the arm by hand.
constexpr Activities hand_guiding = Activity::freedrive | Activity::teach_mode;
/// These may outlast the goal that starts them.
constexpr Activities outlasting_modes = hand_guiding | Activity::force_mode;

}  // namespace ur_ros_rtde
