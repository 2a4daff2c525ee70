#pragma once

#include <optional>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// A command whose work is done on the controller, by a piece of URScript that becomes part of the control
/// program.
///
///     class SgGetWidth : public Extension<action::SgGetWidth> {
///       ScriptExtension script() const override
///       {
///         return {.snippet = "$out19f(get_sg_Width($in19i))"};
///       }
///       Outcome run(const Goal & goal, Run & run) override
///       {
///         run.registers().set_int(19, goal.tool_index);
///         auto outcome = run.trigger(2.0);
///         run.result().width = run.registers().get_double(19) / 1000.0;
///         return outcome;
///       }
///     };
///     UR_ROS_RTDE_EXPORT(SgGetWidth, "sg_get_width")
///
/// What the snippet may use: script_extension.hpp. Its name is the plugin's. A snippet that cannot become
/// part of the program (a conflict of registers, a function that the controller does not have) leaves its
/// goals refused with the reason, and everything else as it is; one that fails or does not end ends its goal.
template <typename A>
class Extension : public Command<A> {
 public:
  using Run = typename Command<A>::Run;

  virtual ScriptExtension script() const = 0;
  std::optional<ScriptExtension> script_extension() const final { return script(); }
};

}  // namespace ur_ros_rtde
