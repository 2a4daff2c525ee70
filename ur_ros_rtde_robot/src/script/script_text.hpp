#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ur_ros_rtde::script {

/// Where a line of a composed script comes from.
struct Origin {
  std::size_t source = 0;  ///< as given to ScriptText::copy
  int line = 0;            ///< in that source, from 1; 0: inserted by this package
};

/// A script composed of parts of other scripts, with the origin of each line.
class ScriptText {
 public:
  /// Appends `part`, which begins in line `line` of its source. It need not end with a line end.
  void copy(std::string_view part, int line, std::size_t source = 0);
  /// Appends lines without origin. Ends the current line before and the last line after.
  void insert(std::string_view lines);
  void end_line();

  const std::string & text() const { return text_; }
  /// Origin of line `line` of the composed text, from 1.
  Origin origin(int line) const;

 private:
  std::string text_;
  std::vector<Origin> origins_{Origin{}};  ///< one per line, including the current one
};

}  // namespace ur_ros_rtde::script
