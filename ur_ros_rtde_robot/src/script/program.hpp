#pragma once

#include <string>
#include <string_view>

#include "script/fault.hpp"
#include "script/script_text.hpp"

namespace ur_ros_rtde::script {

struct ProgramOptions {
  bool secondary = false;
  /// Written with `textmsg` when the program begins, and when it comes to an end of its own.
  std::string begin_mark;
  std::string end_mark;
  /// Statements to run before the program's first.
  std::string preamble;
};

/// A script ready to be sent: a whole program that says when it begins and ends.
struct Program {
  std::string name;  ///< after its `def` or `sec`
  ScriptText text;
};

/// Makes a program of `script`, which is a whole one or the body of one. The marks stand in lines of their
/// own, before the last `end`, every `halt`, and every `return` of the program itself; all else stays as it
/// is, the lines' numbers excepted.
Result<Program> make_program(std::string_view script, const ProgramOptions & options);

}  // namespace ur_ros_rtde::script
