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

/// From the word that opens a block (`def sec thread if while`) to its `end`: indices of tokens.
struct Block {
  std::size_t first;
  std::size_t last;
};

struct Scan {
  std::vector<Token> tokens;  ///< without comments
  std::vector<Block> blocks;  ///< in the order of their beginnings

  const Block * block_from(std::size_t token) const;
};

/// Takes URScript to pieces as far as its blocks. Faults: a string or bracket that is not closed, a block
/// without end, an end without block, a control character. Everything else the controller judges.
Result<Scan> scan(std::string_view text);

}  // namespace ur_ros_rtde::script
