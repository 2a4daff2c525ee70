#pragma once

#include <string>
#include <vector>

namespace ur_ros_rtde {

/// General purpose registers of the controller, by their numbers (without the offset of the upper range).
struct ScriptRegisters {
  std::vector<int> input_int, input_double, output_int, output_double;
};

/// What an extension adds to the control script.
///
/// The snippet runs on the robot, in a thread of its own beside ur_rtde's commands, when it is triggered
/// (Robot::run_extension). It reads its parameters from input registers and leaves its results in output
/// registers, written for short: `$in19i` and `$in19f` are the values of input registers, `$out19i(x)` and
/// `$out19f(x)` write output registers (i: integer, f: float). A line that begins with `$5.10 ` is kept from
/// PolyScope 5.10 on, and left out before.
///
/// Free for extensions are the inputs 19 to 22, the integer outputs 12 to 19, and the float outputs 12 to 17
/// and 19; the float registers 18 are the trigger and its acknowledgement, all others ur_rtde's own.
struct ScriptExtension {
  // Initialized, so that g++ 11 does not warn when designated initializers leave members out.
  std::string name{};           ///< of the plugin: lower case letters, digits, underscores
  std::string snippet{};        ///< statements
  std::string preamble_name{};  ///< extensions that share definitions give them the same name and text
  std::string preamble{};       ///< definitions (def, thread, global), once per preamble_name
  /// Used besides those that the short forms in snippet and preamble name.
  ScriptRegisters registers{};
  /// What has to be installed on the robot for the snippet ("the URCap of …"), and functions that it brings.
  /// A controller that does not know one of these lacks it: that is no fault, and goals are refused with what
  /// to install.
  std::string urcap{};
  std::vector<std::string> urcap_functions{};
  /// Its registers hold values between its runs: no other extension may use them. Otherwise registers are
  /// shared, since extensions run one at a time.
  bool exclusive = false;
};

}  // namespace ur_ros_rtde
