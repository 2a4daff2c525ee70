#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A CSV file with a header line (RFC 4180). Numbers are written with full round-trip precision.
class CsvFile {
 public:
  /// Fails (invalid_goal) for a relative path, an existing file, and a directory that is not writable.
  static Expected<CsvFile> create(const std::string & path, const std::vector<std::string> & columns);
  CsvFile(CsvFile && other) noexcept;
  CsvFile & operator=(CsvFile && other) noexcept;
  ~CsvFile();

  const std::string & path() const { return path_; }
  /// Rows in the file, without the header.
  std::uint64_t rows() const { return rows_; }

  /// Buffers a row until flush().
  void append(std::span<const double> row);
  /// Writes the buffered rows. After an error, for example a full disk, the file ends with the last complete
  /// row, and nothing more is written.
  Status flush();
  /// Calls flush() and closes the file.
  Status close();

 private:
  CsvFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
  Status failed(int error);

  int descriptor_ = -1;
  std::string path_;
  std::string text_;
  std::uint64_t buffered_rows_ = 0;  ///< rows in text_
  std::uint64_t rows_ = 0;
  std::int64_t size_ = 0;  ///< bytes, of whole rows
};

}  // namespace ur_ros_rtde
