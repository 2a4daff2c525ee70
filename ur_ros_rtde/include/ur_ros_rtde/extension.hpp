#pragma once

#include <optional>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// A command that is executed on the controller by a snippet of URScript, which becomes part of the control
/// program.
///
///     class SgGetWidth : public Extension<action::SgGetWidth> {
///       ScriptExtension script() const override
///       {
///         return {.snippet = "$out19f(get_sg_Width())"};
///       }
///       Outcome run(const Goal &, Run & run) override
///       {
///         auto outcome = run.trigger(2.0);
///         run.result().width = run.registers().get_double(19) / 1000.0;
///         return outcome;
///       }
///     };
///     UR_ROS_RTDE_EXPORT(SgGetWidth, "sg_get_width")
///
/// script_extension.hpp documents what a snippet may use. If a snippet cannot become part of the program (its
/// registers are taken, or the controller lacks a function), goals of this command are rejected with the
/// reason; other commands are not affected. A snippet that fails or does not end fails its goal.
template <typename A>
class Extension : public Command<A> {
 public:
  using Run = typename Command<A>::Run;

  /// The snippet, and what it needs. Called more than once.
  virtual ScriptExtension script() const = 0;

  // For the driver

  std::optional<ScriptExtension> script_extension() const final { return script(); }
};

}  // namespace ur_ros_rtde
