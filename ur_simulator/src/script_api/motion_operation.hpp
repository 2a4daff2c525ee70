#pragma once

#include <functional>
#include <string>

#include "motion/arm.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

/// A call that moves the arm. It lasts until Arm::call_complete(); meanwhile no other call may move the arm.
class MotionOperation : public urscript::PendingCall {
 public:
  MotionOperation(RobotContextPtr robot, MotionId motion);
  ~MotionOperation() override;
  MotionOperation(const MotionOperation &) = delete;
  MotionOperation & operator=(const MotionOperation &) = delete;

  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override;
  void cancel() override;
  /// The command `abort` of interpreter mode: a motion to a target ends with a controlled stop.
  virtual void abort() {}

 protected:
  RobotContext & robot() { return *robot_; }
  MotionId motion() const { return motion_; }
  void set_motion(MotionId motion) { motion_ = motion; }
  void release();

 private:
  RobotContextPtr robot_;
  MotionId motion_;
};

/// A motion with a target. A protective or safeguard stop cancels the motion and pauses the program; when the
/// program resumes, the motion to the same target is started again.
class MoveOperation final : public MotionOperation {
 public:
  using StartFunction = std::function<StartResult(Arm & arm)>;

  MoveOperation(RobotContextPtr robot, MotionId motion, StartFunction start);
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override;
  void abort() override;

 private:
  tl::expected<std::optional<Value>, std::string> abort_complete();

  StartFunction start_;
  bool aborted_ = false;
};

/// Starts a motion without a target to resume to (servoj, speedj, stopj, …).
Outcome start_motion(const RobotContextPtr & robot, const std::function<StartResult(Arm & arm)> & start);
/// Starts a motion to a target. The outcome is a value if the motion is skipped.
Outcome start_move(const RobotContextPtr & robot, MoveOperation::StartFunction start);

}  // namespace ur_simulator::script_api
