#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

// The robot also stops a program in which two threads move the arm at the same time.
const Failure robot_in_use{"Another thread is already controlling the robot"};

}  // namespace

MotionOperation::MotionOperation(RobotContextPtr robot, MotionId motion)
    : robot_(std::move(robot)), motion_(motion)
{
  robot_->motion_owner = this;
}

MotionOperation::~MotionOperation()
{
  release();
}

void MotionOperation::release()
{
  if (robot_->motion_owner == this) {
    robot_->motion_owner = nullptr;
  }
}

tl::expected<std::optional<Value>, std::string> MotionOperation::poll(CallContext &)
{
  if (!robot_->access.arm.call_complete(motion_)) {
    return std::nullopt;
  }
  release();
  return Value();
}

void MotionOperation::cancel()
{
  robot_->access.arm.cancel(motion_);
  release();
}

MoveOperation::MoveOperation(RobotContextPtr robot, MotionId motion, StartFunction start)
    : MotionOperation(std::move(robot), motion), start_(std::move(start))
{
}

tl::expected<std::optional<Value>, std::string> MoveOperation::poll(CallContext & context)
{
  // In its blend the motion reaches its target without being restarted.
  Arm & arm = robot().access.arm;
  if (aborted_) {
    return abort_complete();
  }
  const bool arrives = arm.in_blend(motion()) || arm.reached_target(motion());
  auto result = MotionOperation::poll(context);
  if (!result || !*result || arrives) {
    return result;
  }
  const StartResult again = start_(arm);
  if (!again) {
    return tl::unexpected(again.error());
  }
  if (*again == skipped_motion_id) {
    return Value();  // stopped inside its blend
  }
  set_motion(*again);
  robot().motion_owner = this;
  return std::nullopt;
}

tl::expected<std::optional<Value>, std::string> MoveOperation::abort_complete()
{
  if (robot().access.arm.active(motion())) {
    return std::nullopt;
  }
  release();
  return Value();
}

void MoveOperation::abort()
{
  aborted_ = true;
  robot().access.arm.cancel(motion());
}

Outcome start_motion(const RobotContextPtr & robot, const std::function<StartResult(Arm & arm)> & start)
{
  if (robot->motion_owner != nullptr) {
    return robot_in_use;
  }
  const StartResult motion = start(robot->access.arm);
  if (!motion) {
    return Failure{motion.error()};
  }
  return std::make_unique<MotionOperation>(robot, *motion);
}

Outcome start_move(const RobotContextPtr & robot, MoveOperation::StartFunction start)
{
  if (robot->motion_owner != nullptr) {
    return robot_in_use;
  }
  const StartResult motion = start(robot->access.arm);
  if (!motion) {
    return Failure{motion.error()};
  }
  if (*motion == skipped_motion_id) {
    return Value();
  }
  return std::make_unique<MoveOperation>(robot, *motion, std::move(start));
}

}  // namespace ur_simulator::script_api
