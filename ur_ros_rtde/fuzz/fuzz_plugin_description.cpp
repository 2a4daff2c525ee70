#include <sys/mman.h>
#include <unistd.h>

#include <system_error>

#include "input.hpp"
#include "plugins/plugin_index.hpp"

// The plugin description of a package (plugins.xml).

namespace {

/// A file without a disk.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("plugins.xml", MFD_CLOEXEC))
  {
    if (file_ < 0) {
      throw std::system_error(errno, std::generic_category(), "memfd_create");
    }
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile &) = delete;
  MemoryFile & operator=(const MemoryFile &) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }
  void set_content(std::string_view bytes) const
  {
    if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, bytes.data(), bytes.size(), 0) < 0) {
      throw std::system_error(errno, std::generic_category(), path());
    }
  }

 private:
  int file_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static const MemoryFile file;
  file.set_content(ur_fuzz::Input(data, size).take_piece(0));
  for (const auto & entry :
       ur_ros_rtde::read_plugins_file(file.path(), "package", "/nowhere", [](const auto &) {})) {
    if (entry.name.empty() || entry.type.empty() || entry.library.empty()) {
      __builtin_trap();
    }
  }
  return 0;
}
