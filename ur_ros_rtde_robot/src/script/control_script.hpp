#pragma once

#include <map>
#include <string>
#include <vector>

#include "script/fault.hpp"
#include "script/script_text.hpp"
#include "ur_ros_rtde_robot/program/script_extension.hpp"

namespace ur_ros_rtde::script {

/// The control script with what extensions add to it.
struct ControlScript {
  ScriptText text;
  /// What the sources of the text's lines are called: 0 the control script, then the extensions' parts.
  std::vector<std::string> sources;
  /// The number that triggers each extension: from 256, in the order of their names.
  std::map<std::string, int> ids;
};

/// Adds the extensions to ur_rtde's control script `base`, whose version markers stay. Faults name the
/// extension, and the line of its snippet.
Result<ControlScript> compose(const std::string & base, std::vector<ScriptExtension> extensions);

/// For one controller: lines that its version does not know are left out, and the register offset is put in.
/// The lines' origins stay known.
Result<ControlScript> for_controller(const ControlScript & script, unsigned major, unsigned minor,
                                     bool upper_range_registers);

/// "extension `x`, line 3" for a line of the composed text; empty for a line of the control script's own.
std::string place(const ControlScript & script, int line);

}  // namespace ur_ros_rtde::script
