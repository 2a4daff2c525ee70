#pragma once

#include <string>
#include <vector>

namespace ur_ros_rtde {

/// General purpose registers of the controller, by number, without the offset of the upper range.
struct ScriptRegisters {
  std::vector<int> input_int, input_double, output_int, output_double;
};

/// URScript code that an extension adds to the control script.
///
/// Robot::run_extension() triggers the snippet. It runs on the robot, in its own thread beside ur_rtde's
/// commands (a blocking one, such as a synchronous moveJ, delays its begin, which fails after 1 s), reads its
/// parameters from input registers and writes its results to output registers. Snippets use short forms for
/// registers: `$in19i` and `$in19f` are the values of input registers, `$out19i(x)` and
/// `$out19f(x)` write output registers (i: integer, f: float). A line that begins with `$5.10 ` is used from
/// PolyScope 5.10 on and omitted for earlier versions.
///
/// Extensions may use the inputs 19 to 22, the integer outputs 12 to 19, and the float outputs 13 to 17 and
/// 19. The float registers 18 are the trigger and its acknowledgement. All other registers belong to ur_rtde.
struct ScriptExtension {
  // Initialized, so that g++ 11 does not warn when designated initializers leave members out.
  std::string name{};           ///< of the plugin: lower case letters, digits, underscores
  std::string snippet{};        ///< statements
  std::string preamble_name{};  ///< extensions that share definitions use the same name and the same text
  std::string preamble{};       ///< definitions (def, thread, global), included once per preamble_name
  /// Registers used in addition to those of the short forms in snippet and preamble.
  ScriptRegisters registers{};
  /// Software that the snippet requires on the robot ("the URCap of …"), and the script functions that this
  /// software provides. If the controller does not know one of these functions, the software is missing. This
  /// is not an error; goals are rejected with a message that names what to install.
  std::string urcap{};
  std::vector<std::string> urcap_functions{};
  /// The registers keep their values between runs, so no other extension may use them. Otherwise extensions
  /// share registers, since only one runs at a time.
  bool exclusive = false;
};

}  // namespace ur_ros_rtde
