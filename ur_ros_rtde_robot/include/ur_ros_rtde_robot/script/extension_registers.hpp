#pragma once

#include <string>

namespace ur_ros_rtde::script {

/// Numbers of general purpose registers, without the offset of the upper range.
struct RegisterRange {
  int first;
  int last;
  int excluded = -1;  ///< a number between first and last; -1: none

  constexpr bool contains(int number) const
  {
    return number >= first && number <= last && number != excluded;
  }
};

/// Registers available to extensions; docs/use/writing_a_plugin.md lists the users of all others. The float
/// registers 18 are the trigger and its acknowledgement, output 12 is the time of servoJ's target. ur_rtde's
/// IO interface writes the inputs 18 to 22, its receive interface reads the outputs 12 to 19.
inline constexpr int trigger_register = 18;          ///< input float register
inline constexpr int acknowledgement_register = 18;  ///< output float register
inline constexpr RegisterRange free_inputs{19, 22};  ///< integer and float
inline constexpr RegisterRange free_int_outputs{12, 19};
inline constexpr RegisterRange free_float_outputs{13, 19, 18};

/// "13 to 19 except 18"
inline std::string to_string(const RegisterRange & range)
{
  return std::to_string(range.first) + " to " + std::to_string(range.last) +
         (range.excluded < 0 ? std::string() : " except " + std::to_string(range.excluded));
}

}  // namespace ur_ros_rtde::script
