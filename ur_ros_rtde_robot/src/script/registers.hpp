#pragma once

#include <string>

#include "script/fault.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"

namespace ur_ros_rtde::script {

/// Expands the short forms of registers (`$in19i`) in `text` and adds the registers to `used`.
Result<std::string> expand_registers(const std::string & text, ScriptRegisters & used);

/// Checks that extensions may use these registers.
Result<void> check_registers(const ScriptRegisters & used);

/// A register that both use, such as "input float register 20"; empty if there is none.
std::string common_register(const ScriptRegisters & a, const ScriptRegisters & b);

}  // namespace ur_ros_rtde::script
