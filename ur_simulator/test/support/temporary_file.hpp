#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace ur_simulator::testing {

/// The path of a file in the folder for temporary files. The file is removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string & name)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_" + name))
  {
  }
  /// Creates the file with this content.
  TemporaryFile(const std::string & name, std::string_view text) : TemporaryFile(name)
  {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile &) = delete;
  TemporaryFile & operator=(const TemporaryFile &) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace ur_simulator::testing
