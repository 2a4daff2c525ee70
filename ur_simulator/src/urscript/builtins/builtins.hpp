#pragma once

#include "urscript/library.hpp"

namespace ur_simulator::urscript {

// Groups of builtins that add_standard_builtins() adds, as in the modules of the script manual.
void add_math_builtins(Library & library);
void add_list_builtins(Library & library);
void add_string_builtins(Library & library);
void add_pose_builtins(Library & library);
void add_program_builtins(Library & library);

}  // namespace ur_simulator::urscript
