#pragma once

#include <map>
#include <string>
#include <vector>

#include "script/fault.hpp"
#include "script/script_text.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"

namespace ur_ros_rtde::script {

/// The control script with the code of the extensions.
struct ControlScript {
  ScriptText text;
  /// Names of the sources of the lines: 0 is the control script, followed by the parts of the extensions.
  std::vector<std::string> sources;
  /// The number that triggers each extension: from 256, in order of their names.
  std::map<std::string, int> ids;
};

/// Adds the extensions to ur_rtde's control script `base` and keeps its version markers. Faults name the
/// extension and the line of its snippet.
Result<ControlScript> compose(const std::string & base, std::vector<ScriptExtension> extensions);

/// The script for one controller: without the lines for other versions and with the register offset. Keeps
/// the origins of the lines.
Result<ControlScript> for_controller(const ControlScript & script, unsigned major, unsigned minor,
                                     bool upper_range_registers);

/// "extension `x`, line 3" for a line of the composed text; empty for a line of the control script itself.
std::string place(const ControlScript & script, int line);

}  // namespace ur_ros_rtde::script
