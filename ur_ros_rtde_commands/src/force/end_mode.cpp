#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// Ends a mode that a previous goal has activated, and waits for standstill.
class EndModeCommand : public Command<ur_ros_rtde_msgs::action::Trigger> {
 public:
  EndModeCommand(Mode::EndFunction end, std::string mode, bool is_hand_guiding)
      : end_(end), mode_(std::move(mode)), is_hand_guiding_(is_hand_guiding)
  {
  }

 private:
  CommandTraits traits() const override
  {
    return {.leaves_mode_active = true, .switches_hand_guiding = is_hand_guiding_};
  }
  Outcome run(const Goal &, Run & run) override
  {
    Mode(run, end_, mode_).end();
    const auto stop_reason = run.until_standstill();
    return stop_reason ? Outcome(*stop_reason) : Outcome::success();
  }

  const Mode::EndFunction end_;
  const std::string mode_;
  const bool is_hand_guiding_;
};

class EndTeachMode : public EndModeCommand {
 public:
  EndTeachMode() : EndModeCommand(&ur_rtde::RTDEControlInterface::endTeachMode, "teach mode", true) {}
};

UR_ROS_RTDE_EXPORT(EndTeachMode, "end_teach_mode")

class FreedriveStop : public EndModeCommand {
 public:
  FreedriveStop() : EndModeCommand(&ur_rtde::RTDEControlInterface::endFreedriveMode, "freedrive", true) {}
};

UR_ROS_RTDE_EXPORT(FreedriveStop, "freedrive_stop")

class ForceModeStop : public EndModeCommand {
 public:
  ForceModeStop() : EndModeCommand(&ur_rtde::RTDEControlInterface::forceModeStop, "force mode", false) {}
};

UR_ROS_RTDE_EXPORT(ForceModeStop, "force_mode_stop")

}  // namespace ur_ros_rtde
