#pragma once

#include "urscript/library.hpp"

namespace ur_simulator::urscript {

// The groups of add_standard_builtins, as the script manual's modules have them.
void add_math_builtins(Library & library);
void add_list_builtins(Library & library);
void add_string_builtins(Library & library);
void add_pose_builtins(Library & library);
void add_program_builtins(Library & library);

}  // namespace ur_simulator::urscript
