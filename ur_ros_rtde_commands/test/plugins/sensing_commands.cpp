// Commands that use RTDE outputs, and settings that are put back.
#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/send_script.hpp>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/outputs.hpp"
#include "ur_ros_rtde/tool_settings.hpp"

namespace ur_ros_rtde {

using ur_ros_rtde_msgs::action::SendScript;

/// Waits until the output that `script` names is above 4, for `timeout` seconds. The result has the joint
/// positions of that package.
class WaitsForOutput : public Command<SendScript> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Outputs outputs(run.robot(), {"timestamp", "actual_q", goal.script});
    const auto is_above = [&] { return outputs.number(goal.script) > 4.0; };
    const Outcome outcome = run.expect(
        is_above,
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(goal.timeout)),
        "the value is too small", ErrorCode::not_reached);
    for (const double position : outputs.vector("actual_q")) {
      run.result().output.push_back(fmt::format("{}", position));
    }
    return outcome;
  }
};

/// Has a payload of 2 kg and a TCP 0.1 m away from the flange for `timeout` seconds, and turns wrist 3.
class UsesAnotherTool : public Command<SendScript> {
  Outcome run(const Goal & goal, Run & run) override
  {
    TemporarySetting payload = temporary_payload(run, 2.0, {0.0, 0.0, 0.05});
    TemporarySetting tcp = temporary_tcp(run, {0.0, 0.0, 0.1, 0.0, 0.0, 0.0});
    if (goal.script == "keep") {
      payload.keep();
      tcp.keep();
    }
    run.control()->speedJ({0.0, 0.0, 0.0, 0.0, 0.0, 0.2}, 1.0, 0.0);
    const auto why = run.sleep_for(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(goal.timeout)));
    return why ? Outcome(*why) : run.stop_motion();
  }
};

/// Sets a TCP 0.1 m away from the flange, which is not confirmed.
class FailsToSetTheTool : public Command<SendScript> {
  Outcome run(const Goal &, Run & run) override
  {
    const TemporarySetting tcp(
        run, "the TCP",
        [&] {
          const Outcome set = set_tcp(run, {0.0, 0.0, 0.1, 0.0, 0.0, 0.0});
          return set ? Outcome::failure(ErrorCode::rejected_by_robot, "not confirmed") : set;
        },
        [](ur_rtde::RTDEControlInterface & control) {
          return control.setTcp({0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
        });
    return Outcome::success();
  }
};

/// The result has the pose of the frame that `script` names.
class TellsFrame : public Command<SendScript> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto pose = run.frame(goal.script);
    if (!pose) {
      return pose.error();
    }
    for (const double value : *pose) {
      run.result().output.push_back(fmt::format("{}", value));
    }
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(TellsFrame, "tells_frame")
UR_ROS_RTDE_EXPORT(WaitsForOutput, "waits_for_output")
UR_ROS_RTDE_EXPORT(UsesAnotherTool, "uses_another_tool")
UR_ROS_RTDE_EXPORT(FailsToSetTheTool, "fails_to_set_the_tool")

}  // namespace ur_ros_rtde
