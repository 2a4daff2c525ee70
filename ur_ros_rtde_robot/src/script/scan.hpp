#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "script/fault.hpp"

namespace ur_ros_rtde::script {

struct Token {
  enum class Kind { word, string, symbol };

  Kind kind;
  std::string_view text;  ///< into the scanned text; a string with its quotes
  std::size_t offset;
  int line;  ///< from 1

  bool is(std::string_view word) const { return kind != Kind::string && text == word; }
};

/// Token indices of the word that opens a block (`def sec thread if while`) and of its `end`.
struct Block {
  std::size_t first;
  std::size_t last;
};

struct Scan {
  std::vector<Token> tokens;  ///< without comments
  std::vector<Block> blocks;  ///< in order of their first tokens

  const Block * block_from(std::size_t token) const;
};

/// Splits URScript into tokens and blocks. Faults: an unclosed string or bracket, a block without `end`, an
/// `end` without block, a control character. The controller checks everything else.
Result<Scan> scan(std::string_view text);

}  // namespace ur_ros_rtde::script
