#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ur_simulator::urscript {

/// Extracts complete programs from the bytes received on the script ports (30001, 30002, 30003): `def … end`
/// or `sec … end` with all nested blocks, or one bare line. Clients send no length and keep the socket open,
/// so the end is found by counting blocks. A program that exceeds the limit is dropped up to its own end, so
/// that its lines do not run one by one. After a single line that exceeds the limit all further input is
/// ignored.
class ScriptReader {
 public:
  explicit ScriptReader(std::size_t limit = 4U << 20U);

  /// Appends received bytes.
  void feed(std::string_view bytes);
  /// The next complete program, if there is one. Call until it returns nothing.
  std::optional<std::string> next();
  /// Number of bytes of the incomplete program.
  std::size_t pending() const;
  /// Number of programs dropped because they exceeded the limit.
  std::uint64_t dropped() const { return dropped_; }
  /// The connection was closed: discards the incomplete program.
  void reset();

 private:
  bool scan_line(std::string_view line);
  void enforce_limit();

  std::string buffer_;
  std::size_t limit_;
  std::size_t begin_ = 0;    ///< of the program that is being received
  std::size_t scanned_ = 0;  ///< end of the part of the buffer whose blocks have been counted
  std::size_t depth_ = 0;    ///< open blocks at `scanned_`
  std::uint64_t dropped_ = 0;
  bool dropping_ = false;      ///< the program that is being received is too large
  bool ignore_input_ = false;  ///< a line was too large: the end of the program cannot be found
};

}  // namespace ur_simulator::urscript
