// Commands whose objects end before the goal does.
#include <chrono>
#include <ur_ros_rtde_msgs/action/send_script.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/mode.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde/supervision.hpp"
#include "ur_ros_rtde/tool_settings.hpp"

namespace ur_ros_rtde {

using ur_ros_rtde_msgs::action::SendScript;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// Asks the control program and switches force mode on and off while a motion of 0.4 rad is under way, or
/// after it has ended (`script`: "late"), and then waits for its end.
class AsksDuringAMotion : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 & q = run.state().actual_q;
    const std::vector<double> target{q[0], q[1], q[2], q[3], q[4], q[5] + 0.4};
    check_result(run.control()->moveJ(target, 0.2, 1.0, true), "move");
    if (auto why = run.sleep_for(goal.script == "late" ? 4s : 200ms)) {
      return *why;
    }
    static_cast<void>(run.control()->getTCPOffset());
    return run.until_joints_reached(target);
  }
};

/// Repeats a check that asks the robot, which says no.
class ChecksAgain : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.check_again([&](Check & check) {
      check.query([&](Robot &) -> Status { return failure(ErrorCode::unreachable, goal.script); });
    });
  }
};

/// Starts something that moves the arm, whose object ends, and waits for `timeout` s.
class EndsItsScope : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override
  {
    const auto begun = begin(goal.script, run);
    if (!begun) {
      return begun;
    }
    const auto why = run.sleep_for(std::chrono::milliseconds(static_cast<int>(1000.0 * goal.timeout)));
    return why ? Outcome(*why) : Outcome::success();
  }

  static Outcome begin(const std::string & what, Run & run)
  {
    if (what == "mode") {
      const Mode pressing = start_force_mode(run, {.compliant = {false, false, true, false, false, false}});
      return turn(run);
    }
    if (what == "payload") {
      const TemporarySetting payload = temporary_payload(run, 2.0, {0.0, 0.0, 0.05});
      return turn(run);
    }
    if (what == "payload and mode") {
      const TemporarySetting payload = temporary_payload(run, 2.0, {0.0, 0.0, 0.05});
      const Mode pressing = start_force_mode(run, {.compliant = {false, false, true, false, false, false}});
      const auto why = run.sleep_for(30s);
      return why ? Outcome(*why) : Outcome::success();
    }
    const StreamOptions options;
    TargetStream stream(run, follow_twists(options), options);
    for (int i = 0; i < 100; ++i) {
      if (auto why = stream.wait()) {
        return *why;
      }
      if (Status sent = stream.set({{0.0, 0.0, 0.05, 0.0, 0.0, 0.0}}); !sent) {
        return sent;
      }
      if (Status sent = stream.send(); !sent) {
        return sent;
      }
    }
    return Outcome::success();
  }

  static Outcome turn(Run & run)
  {
    check_result(run.control()->speedJ({0.0, 0.0, 0.0, 0.0, 0.0, 0.2}, 1.0, 0.0), "turn");
    const auto why = run.sleep_for(300ms);
    return why ? Outcome(*why) : Outcome::success();
  }
};

/// Lets no goal move the arm while digital input 7 is on. Its goal ends that.
class WatchesADoor : public Command<SendScript> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void on_load(CommandHost & host) override
  {
    door_.emplace(host, StopOptions{}, WhileReasonPersists::reject,
                  [](const Sample & sample) -> std::optional<Error> {
                    constexpr std::uint64_t door = 1U << 7U;
                    return (sample.digital_inputs & door) != 0
                               ? std::optional(Error{ErrorCode::not_ready, "the door is open"})
                               : std::nullopt;
                  });
  }
  void on_unload() override { door_.reset(); }
  Outcome run(const Goal &, Run &) override
  {
    door_->end();
    return Outcome::success();
  }

  std::optional<Supervision> door_;
};

UR_ROS_RTDE_EXPORT(AsksDuringAMotion, "asks_during_a_motion")
UR_ROS_RTDE_EXPORT(ChecksAgain, "checks_again")
UR_ROS_RTDE_EXPORT(EndsItsScope, "ends_its_scope")
UR_ROS_RTDE_EXPORT(WatchesADoor, "watches_a_door")

}  // namespace ur_ros_rtde
