#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A file of comma-separated numbers with a head line (RFC 4180). Numbers are written with as many digits as
/// it takes to read the same double again.
class CsvFile {
 public:
  /// Refused (invalid_goal) for a relative path, a file that exists, a folder that cannot be written.
  static Expected<CsvFile> create(const std::string & path, const std::vector<std::string> & columns);
  CsvFile(CsvFile && other) noexcept;
  CsvFile & operator=(CsvFile && other) noexcept;
  ~CsvFile();

  const std::string & path() const { return path_; }
  /// In the file, without the head line.
  std::uint64_t rows() const { return rows_; }

  /// Kept until flush().
  void append(std::span<const double> row);
  /// After an error (a full disk) the file ends with the last whole row, and takes no more.
  Status flush();
  /// flush(), and the file is closed.
  Status close();

 private:
  CsvFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
  Status failed(int error);

  int descriptor_ = -1;
  std::string path_;
  std::string text_;
  std::uint64_t waiting_ = 0;  ///< rows in text_
  std::uint64_t rows_ = 0;
  std::int64_t size_ = 0;  ///< bytes, of whole rows
};

}  // namespace ur_ros_rtde
