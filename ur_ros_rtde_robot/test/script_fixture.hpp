#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {

struct ScriptTest : RobotFixture {
  static ScriptOptions secondary()
  {
    ScriptOptions options;
    options.kind = ScriptKind::secondary;
    options.timeout = 5s;
    return options;
  }

  /// A long joint motion.
  static std::string turning()
  {
    return "def turn():\n"
           "  q = get_actual_joint_positions()\n"
           "  q[0] = q[0] + 3\n"
           "  movej(q, a=2, v=0.8)\n"
           "end\n";
  }

  /// Calls `event` once, while the script moves the arm.
  ScriptOptions when_it_turns(std::function<void()> event)
  {
    ScriptOptions options;
    options.stop_reason = [this, event = std::move(event),
                           told = std::make_shared<std::atomic<bool>>(false)]() -> std::optional<Error> {
      if (turns() && !told->exchange(true)) {
        event();
      }
      return std::nullopt;
    };
    return options;
  }

  /// Stops a script when the control program has yielded to it, and returns the generation of that moment.
  Generation stop_before_begin(const std::function<void()> & event)
  {
    Generation received;
    ScriptOptions options;
    options.stop_reason = [&]() -> std::optional<Error> {
      received = robot->generation();
      event();
      return stopped_by_the_driver();
    };
    EXPECT_EQ(run_script(turning(), options).end, ScriptEnd::rejected);
    return received;
  }

  bool plays() { return controller.state().at("program").at("state") == "PLAYING"; }

  bool turns() { return std::abs(robot->latest()->actual_qd[0]) > 0.7; }

  /// The control program runs again and accepts commands.
  testing::AssertionResult is_back()
  {
    if (const auto ready = robot->ready_to_move(); !ready) {
      return testing::AssertionFailure() << ready.error().message << "\n" << log.text();
    }
    const auto q = robot->receive()->getActualQ();
    const auto mark = robot->mark_motion();
    auto there = q;
    there[5] += 0.02;
    if (!control()->moveJ(there, 1.0, 2.0, true) ||
        !eventually([&] { return robot->motion_progress(mark).finished(); })) {
      return testing::AssertionFailure() << "the arm does not move\n" << log.text();
    }
    return testing::AssertionSuccess();
  }
};

}  // namespace ur_ros_rtde::test
