#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

namespace {

// Two threads that move at once stop the program on the robot too.
const Failure occupied{"Another thread is already controlling the robot"};

}  // namespace

MotionOperation::MotionOperation(RobotPtr robot, MotionId motion) : robot_(std::move(robot)), motion_(motion)
{
  robot_->moving = this;
}

MotionOperation::~MotionOperation()
{
  release();
}

void MotionOperation::release()
{
  if (robot_->moving == this) {
    robot_->moving = nullptr;
  }
}

tl::expected<std::optional<Value>, std::string> MotionOperation::poll(CallContext &)
{
  if (!robot_->access.arm.finished(motion_)) {
    return std::nullopt;
  }
  release();
  return Value();
}

void MotionOperation::abandon()
{
  robot_->access.arm.abandon(motion_);
  release();
}

MoveOperation::MoveOperation(RobotPtr robot, MotionId motion, Start start)
    : MotionOperation(std::move(robot), motion), start_(std::move(start))
{
}

tl::expected<std::optional<Value>, std::string> MoveOperation::poll(CallContext & context)
{
  // In its blend it goes on to its target, whether the program has something to blend with it or not.
  Arm & arm = robot().access.arm;
  const bool arrives = arm.in_blend(motion()) || arm.arrived(motion());
  auto result = MotionOperation::poll(context);
  if (!result || !*result || arrives) {
    return result;
  }
  const MotionStart again = start_(arm);
  if (!again) {
    return tl::unexpected(again.error());
  }
  if (*again == skipped_motion) {
    return Value();  // it was stopped so near to its target that its blend has begun
  }
  follow(*again);
  robot().moving = this;
  return std::nullopt;
}

Outcome begin_motion(const RobotPtr & robot, const std::function<MotionStart(Arm & arm)> & start)
{
  if (robot->moving != nullptr) {
    return occupied;
  }
  const MotionStart motion = start(robot->access.arm);
  if (!motion) {
    return Failure{motion.error()};
  }
  return std::make_unique<MotionOperation>(robot, *motion);
}

Outcome begin_move(const RobotPtr & robot, MoveOperation::Start start)
{
  if (robot->moving != nullptr) {
    return occupied;
  }
  const MotionStart motion = start(robot->access.arm);
  if (!motion) {
    return Failure{motion.error()};
  }
  if (*motion == skipped_motion) {
    return Value();
  }
  return std::make_unique<MoveOperation>(robot, *motion, std::move(start));
}

}  // namespace ur_simulator::script_api
