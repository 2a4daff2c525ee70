#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace ur_simulator {

/// Writes a Mermaid sequence diagram to a file, in a thread of its own. Thread-safe.
class DiagramWriter {
 public:
  /// "-": standard output. Throws std::runtime_error with the name of the file if it cannot be opened.
  explicit DiagramWriter(const std::string & file);
  /// Writes the remaining lines.
  ~DiagramWriter();
  DiagramWriter(const DiagramWriter &) = delete;
  DiagramWriter & operator=(const DiagramWriter &) = delete;

  /// Adds a line to the diagram, without its line end. Does not wait for the file: while more than
  /// `queue_limit` bytes are unwritten, lines are left out, and a comment states their number.
  void add(std::string_view line);

  static constexpr std::size_t queue_limit = 1024 * 1024;

 private:
  void run();
  /// Waits for lines and takes them. Empty: the end.
  std::string take_lines();
  bool write(std::string_view bytes) const;

  const std::string name_;
  const int file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string queue_;           ///< unwritten lines
  std::uint64_t left_out_ = 0;  ///< since the last lines in the queue
  bool closing_ = false;
  bool failed_ = false;  ///< writing has failed: all further lines are discarded
  std::thread thread_;
};

}  // namespace ur_simulator
