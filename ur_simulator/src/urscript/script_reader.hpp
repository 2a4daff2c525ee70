#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ur_simulator::urscript {

/// Cuts complete programs out of the bytes that arrive on the script ports (30001, 30002, 30003): `def …
/// end`, `sec … end` with everything nested in it, or one bare line. Clients keep the socket open and send no
/// length, so the end is found by counting blocks. Bounded: a program that outgrows the limit is dropped as a
/// whole, up to its own end (its lines must not run one by one); when a single line outgrows it, everything
/// after is ignored.
class ScriptReader {
 public:
  explicit ScriptReader(std::size_t limit = 4U << 20U);

  /// Takes what arrived.
  void feed(std::string_view bytes);
  /// The next complete program, if there is one. Call until empty.
  std::optional<std::string> next();
  /// Bytes of a program that is not complete yet.
  std::size_t pending() const;
  /// Programs dropped because they were larger than the limit.
  std::uint64_t dropped() const { return dropped_; }
  /// The connection ended: what is pending will never be complete.
  void reset();

 private:
  bool scan_line(std::string_view line);
  void bound();

  std::string buffer_;
  std::size_t limit_;
  std::size_t begin_ = 0;    ///< of the program that is being received
  std::size_t scanned_ = 0;  ///< up to here the buffer has been counted
  std::size_t depth_ = 0;    ///< open blocks at `scanned_`
  std::uint64_t dropped_ = 0;
  bool dropping_ = false;  ///< the program being received is too large
  bool deaf_ = false;      ///< a line was too large: where the program ends cannot be known
};

}  // namespace ur_simulator::urscript
