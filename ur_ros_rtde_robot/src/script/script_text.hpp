#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ur_ros_rtde::script {

/// Where a line of a composed script comes from.
struct Origin {
  std::size_t source = 0;  ///< as given to ScriptText::copy
  int line = 0;            ///< of that source, from 1; 0: added by us
};

/// A script put together from parts of others, that remembers where each line comes from.
class ScriptText {
 public:
  /// `part` begins in line `line` of its source. It need not end with its line.
  void copy(std::string_view part, int line, std::size_t source = 0);
  /// Lines of our own; ends the line before, if there is one, and its own.
  void insert(std::string_view lines);
  void end_line();

  const std::string & text() const { return text_; }
  /// Of line `line` of the composed text, from 1.
  Origin origin(int line) const;

 private:
  std::string text_;
  std::vector<Origin> origins_{Origin{}};  ///< of each line, the one under way included
};

}  // namespace ur_ros_rtde::script
