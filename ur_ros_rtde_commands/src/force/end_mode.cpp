#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// Ends a mode that a previous goal has activated, and waits for standstill.
class EndModeCommand : public Command<ur_ros_rtde_msgs::action::Trigger> {
 public:
  EndModeCommand(Mode::EndFunction end, Activity activity, std::string mode)
      : end_(end), activity_(activity), mode_(std::move(mode))
  {
  }

 private:
  CommandTraits traits() const override
  {
    return {.leaves_mode_active = true, .switches_hand_guiding = hand_guiding.contains(activity_)};
  }
  void check(const Goal &, Check & check) const override
  {
    check.query([this](const Robot & robot) { return is_not_in_the_other_mode(robot); });
  }
  Outcome run(const Goal &, Run & run) override
  {
    Mode(run, end_, mode_).end();
    const auto stop_reason = run.until_standstill();
    return stop_reason ? Outcome(*stop_reason) : Outcome::success();
  }
  /// The driver would take it to be on, although the controller may have ended it.
  Status is_not_in_the_other_mode(const Robot & robot) const
  {
    const Activities other = (robot.activities() & hand_guiding).without(activity_);
    const bool is_freedrive = other.contains(Activity::freedrive);
    return other.empty()
               ? Status()
               : failure(ErrorCode::busy, fmt::format("the arm is in {}, which {} ends",
                                                      is_freedrive ? "freedrive" : "teach mode",
                                                      is_freedrive ? "freedrive_stop" : "end_teach_mode"));
  }

  const Mode::EndFunction end_;
  const Activity activity_;
  const std::string mode_;
};

class EndTeachMode : public EndModeCommand {
 public:
  EndTeachMode()
      : EndModeCommand(&ur_rtde::RTDEControlInterface::endTeachMode, Activity::teach_mode, "teach mode")
  {
  }
};

UR_ROS_RTDE_EXPORT(EndTeachMode, "end_teach_mode")

class FreedriveStop : public EndModeCommand {
 public:
  FreedriveStop()
      : EndModeCommand(&ur_rtde::RTDEControlInterface::endFreedriveMode, Activity::freedrive, "freedrive")
  {
  }
};

UR_ROS_RTDE_EXPORT(FreedriveStop, "freedrive_stop")

class ForceModeStop : public EndModeCommand {
 public:
  ForceModeStop()
      : EndModeCommand(&ur_rtde::RTDEControlInterface::forceModeStop, Activity::force_mode, "force mode")
  {
  }
};

UR_ROS_RTDE_EXPORT(ForceModeStop, "force_mode_stop")

}  // namespace ur_ros_rtde
