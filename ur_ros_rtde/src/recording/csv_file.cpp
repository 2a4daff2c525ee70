#include "recording/csv_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

namespace ur_ros_rtde {
namespace {
std::string system_text(int error)
{
  return std::generic_category().message(error);
}
}  // namespace

Expected<CsvFile> CsvFile::create(const std::string & path, const std::vector<std::string> & columns)
{
  if (path.empty() || path.front() != '/') {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("the file name \"{}\" is relative: it has to begin with '/'", path));
  }
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    const int error = errno;
    return failure(ErrorCode::invalid_goal,
                   error == EEXIST ? fmt::format("{} exists already: it is not overwritten", path)
                                   : fmt::format("{} cannot be written: {}", path, system_text(error)));
  }
  CsvFile file(descriptor, path);
  file.text_ = fmt::format("{}\n", fmt::join(columns, ","));
  if (Status written = file.flush(); !written) {
    return tl::unexpected(written.error());
  }
  return file;
}

CsvFile::CsvFile(CsvFile && other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      text_(std::move(other.text_)),
      buffered_rows_(other.buffered_rows_),
      rows_(other.rows_),
      size_(other.size_)
{
}

CsvFile & CsvFile::operator=(CsvFile && other) noexcept
{
  std::swap(descriptor_, other.descriptor_);
  path_.swap(other.path_);
  text_.swap(other.text_);
  std::swap(buffered_rows_, other.buffered_rows_);
  std::swap(rows_, other.rows_);
  std::swap(size_, other.size_);
  return *this;
}

CsvFile::~CsvFile()
{
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void CsvFile::append(std::span<const double> row)
{
  std::array<char, 32> digits;
  char separator = '\0';
  for (const double number : row) {
    if (separator != '\0') {
      text_.push_back(separator);
    }
    separator = ',';
    text_.append(digits.data(), std::to_chars(digits.begin(), digits.end(), number).ptr);
  }
  text_.push_back('\n');
  ++buffered_rows_;
}

Status CsvFile::flush()
{
  if (descriptor_ < 0) {
    return failure(ErrorCode::exception, fmt::format("{} is closed", path_));
  }
  std::string_view left = text_;
  while (!left.empty()) {
    const auto written = ::write(descriptor_, left.data(), left.size());
    if (written >= 0) {
      left.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return failed(errno);
    }
  }
  size_ += static_cast<std::int64_t>(text_.size());
  rows_ += std::exchange(buffered_rows_, 0);
  text_.clear();
  return {};
}

Status CsvFile::failed(int error)
{
  std::string message = fmt::format("{} cannot be written anymore: {}", path_, system_text(error));
  if (::ftruncate(descriptor_, size_) != 0) {
    message += "; its last line may be incomplete";
  }
  ::close(std::exchange(descriptor_, -1));
  text_.clear();
  buffered_rows_ = 0;
  return failure(ErrorCode::exception, message);
}

Status CsvFile::close()
{
  if (Status written = flush(); !written) {
    return written;
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    return failure(ErrorCode::exception,
                   fmt::format("{} could not be closed: {}", path_, system_text(errno)));
  }
  return {};
}

}  // namespace ur_ros_rtde
