#include "motion/started_activities.hpp"

#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <array>
#include <utility>

namespace ur_ros_rtde {
namespace {

using Control = ur_rtde::RTDEControlInterface;

constexpr std::array<std::pair<std::uint32_t, Activity>, 12> motions_of_ur_rtde{
    {{Control::MOTION_MOVE_JOINT, Activity::joint_move},
     {Control::MOTION_MOVE_LINEAR, Activity::linear_move},
     {Control::MOTION_SPEED_JOINT, Activity::joint_speed},
     {Control::MOTION_SPEED_LINEAR, Activity::linear_speed},
     {Control::MOTION_SERVO_JOINT, Activity::joint_servo},
     {Control::MOTION_SERVO_LINEAR, Activity::linear_servo},
     {Control::MOTION_JOG, Activity::jog},
     {Control::MOTION_TORQUE, Activity::torque},
     {Control::MOTION_FORCE, Activity::force_mode},
     {Control::MOTION_FREEDRIVE, Activity::freedrive},
     {Control::MOTION_TEACH, Activity::teach_mode},
     {Control::MOTION_CONTACT, Activity::contact_detection}}};

constexpr Activities moves = Activity::joint_move | Activity::linear_move;

Activities to_activities(std::uint32_t started)
{
  Activities result;
  for (const auto & [bit, activity] : motions_of_ur_rtde) {
    result = (started & bit) != 0 ? result | activity : result;
  }
  return result;
}

}  // namespace

Activities StartedActivities::now() const
{
  // Before what calls record: one that has ended in between has recorded it.
  Activities result = calls();
  const auto view = tracker_.view();
  if (const auto control = interfaces_.control_interface()) {
    result = result | to_activities(control->getStartedMotions());
    // ur_rtde does not forget a move that has reached its target. The status before the move came over
    // another connection, which may be ahead of the samples or behind them.
    const AsyncStatus before{static_cast<std::uint32_t>(control->getAsyncStatusBeforeLastMove())};
    const bool is_pending =
        view.program_running && (view.async_is_stale || !view.async.has_begun_since(before));
    if (!is_pending && !view.operating()) {
      result = result.without(moves);
    }
  }
  if (registers_.extension_started()) {
    result = result | Activity::extension;
  }
  const std::lock_guard lock(mutex_);
  return fence_ ? result | Activity::script : result;
}

std::uint32_t StartedActivities::sent_moves() const
{
  const auto control = interfaces_.control_interface();
  return control ? control->getSentMoves() : 0;
}

Activities StartedActivities::calls() const
{
  const std::lock_guard lock(mutex_);
  const bool found =
      std::any_of(calls_.begin(), calls_.end(), [](const auto & permit) { return permit->revoked(); });
  return found ? Activities(Activity::call) : Activities();
}

std::shared_ptr<void> StartedActivities::begin_call(std::shared_ptr<const Permit> permit)
{
  const std::lock_guard lock(mutex_);
  const auto call = calls_.insert(calls_.end(), std::move(permit));
  return {nullptr, [this, call](void *) {
            const std::lock_guard end(mutex_);
            calls_.erase(call);
          }};
}

StartedActivities::Script::Script(StartedActivities & activities, std::function<void()> fence)
    : activities_(activities)
{
  const std::lock_guard lock(activities_.mutex_);
  activities_.fence_ = std::move(fence);
  activities_.script_compiled_ = false;
}

StartedActivities::Script::~Script()
{
  const std::lock_guard lock(activities_.mutex_);
  activities_.fence_ = nullptr;
}

void StartedActivities::fence_script() const
{
  const std::lock_guard lock(mutex_);
  if (fence_) {
    fence_();
  }
}

}  // namespace ur_ros_rtde
