#pragma once

#include <memory>
#include <string>

#include "urscript/library.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator {

/// The library without the functions that a version of PolyScope lacks: programs cannot name them.
std::shared_ptr<const urscript::Library> with_functions_of(const PolyscopeVersion & version,
                                                           const urscript::Library & library);

/// A Markdown table of the functions that not every version has.
std::string function_version_reference();

}  // namespace ur_simulator
