#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "polyscope/stored_program.hpp"

namespace ur_simulator::robot_api {

struct NamedProgram {
  std::string name;
  StoredProgram program;
};

/// Reads a .urpx file: the program with the script that PolyScope X has generated from its nodes. The error
/// says what the file lacks.
tl::expected<NamedProgram, std::string> read_program_file(std::string_view document);
/// The .urpx file of a program: the uploaded one, or one with its script.
std::string program_document(const std::string & name, const StoredProgram & program);

}  // namespace ur_simulator::robot_api
