#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ur_ros_rtde {

/// Returns the name that `name` was probably meant to be: the one with the smallest number of insertions,
/// deletions and replacements of a character (Levenshtein distance), at most a fifth of its characters and at
/// least one. Empty if there is none.
std::optional<std::string> most_similar(std::string_view name, const std::vector<std::string> & names);

}  // namespace ur_ros_rtde
