#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ur_simulator {

/// Returns a ZIP archive with the files (name, content), uncompressed. PKWARE, "APPNOTE.TXT - .ZIP File
/// Format Specification", sections 4.3.7, 4.3.12 and 4.3.16.
std::string zip_archive(const std::vector<std::pair<std::string, std::string>> & files);

}  // namespace ur_simulator
