#pragma once

#include <string>
#include <string_view>

#include "script/fault.hpp"
#include "script/script_text.hpp"

namespace ur_ros_rtde::script {

struct ProgramOptions {
  bool secondary = false;
  /// Written with `textmsg` when the program begins and when it ends by itself.
  std::string begin_mark;
  std::string end_mark;
  /// Statements to run before the first statement of the program.
  std::string preamble;
};

/// A program ready to be sent, which reports its begin and end.
struct Program {
  std::string name;  ///< after its `def` or `sec`
  ScriptText text;
};

/// Makes a program from `script`, which is a complete program or a function body. Inserts the marks as
/// separate lines at the begin and before the last `end`, every `halt`, and every `return` of the program
/// itself. Everything else is unchanged except for line numbers.
Result<Program> make_program(std::string_view script, const ProgramOptions & options);

}  // namespace ur_ros_rtde::script
