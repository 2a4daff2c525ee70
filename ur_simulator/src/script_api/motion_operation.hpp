#pragma once

#include <functional>
#include <string>

#include "motion/arm.hpp"
#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

/// A call that moves the arm: lasts until the arm says that it may return, and holds the arm so long.
class MotionOperation : public urscript::Operation {
 public:
  MotionOperation(RobotPtr robot, MotionId motion);
  ~MotionOperation() override;
  MotionOperation(const MotionOperation &) = delete;
  MotionOperation & operator=(const MotionOperation &) = delete;

  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override;
  void abandon() override;

 protected:
  Robot & robot() { return *robot_; }
  MotionId motion() const { return motion_; }
  void follow(MotionId motion) { motion_ = motion; }

 private:
  void release();

  RobotPtr robot_;
  MotionId motion_;
};

/// A motion with a target. A protective or safeguard stop makes the arm give it up while the program is
/// paused; once the program goes on, so does the motion, to the same target.
class MoveOperation final : public MotionOperation {
 public:
  using Start = std::function<MotionStart(Arm & arm)>;

  MoveOperation(RobotPtr robot, MotionId motion, Start start);
  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override;

 private:
  Start start_;
};

/// Starts a motion that ends by itself (servoj, speedj, stopj, …), or tells why it cannot.
Outcome begin_motion(const RobotPtr & robot, const std::function<MotionStart(Arm & arm)> & start);
/// Starts a motion to a target; a value when the motion is skipped.
Outcome begin_move(const RobotPtr & robot, MoveOperation::Start start);

}  // namespace ur_simulator::script_api
