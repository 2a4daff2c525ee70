#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ur_simulator {

/// The bytes of a ZIP archive that holds the files (name, content) as they are, not compressed. PKWARE,
/// "APPNOTE.TXT
/// - .ZIP File Format Specification", sections 4.3.7, 4.3.12, 4.3.16.
std::string zip_archive(const std::vector<std::pair<std::string, std::string>> & files);

}  // namespace ur_simulator
