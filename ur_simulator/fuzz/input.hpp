#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ur_fuzz {

/// The input of a fuzz target. Its first bytes select options, the rest is the received data.
class Input {
 public:
  Input(const std::uint8_t * data, std::size_t size) : rest_(reinterpret_cast<const char *>(data), size) {}

  /// Removes the first byte; 0 at the end.
  unsigned take_option()
  {
    if (rest_.empty()) {
      return 0;
    }
    const auto byte = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return byte;
  }
  /// Removes the first `size` bytes; 0: all.
  std::string_view take_piece(std::size_t size)
  {
    const std::string_view piece = rest_.substr(0, size == 0 ? rest_.size() : size);
    rest_.remove_prefix(piece.size());
    return piece;
  }
  /// Removes the first line and returns it without its line end.
  std::string_view take_line()
  {
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(rest_.size(), line.size() + 1));
    return line;
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

}  // namespace ur_fuzz
