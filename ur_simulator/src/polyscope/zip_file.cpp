#include "polyscope/zip_file.hpp"

#include <boost/crc.hpp>
#include <cstdint>

namespace ur_simulator {
namespace {

constexpr std::uint32_t local_header = 0x04034b50;
constexpr std::uint32_t directory_entry = 0x02014b50;
constexpr std::uint32_t end_of_directory = 0x06054b50;
constexpr std::uint16_t version = 20;
constexpr std::uint16_t first_day = 0x21;  // 1 January 1980: entries carry no time

void put(std::string & to, std::uint64_t value, int bytes)
{
  for (int i = 0; i < bytes; ++i) {
    to += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

/// What the local header and the directory entry have in common.
void put_description(std::string & to, const std::string & name, const std::string & content)
{
  boost::crc_32_type crc;
  crc.process_bytes(content.data(), content.size());
  put(to, version, 2);
  put(to, 0, 2);  // flags
  put(to, 0, 2);  // stored
  put(to, 0, 2);  // time
  put(to, first_day, 2);
  put(to, crc.checksum(), 4);
  put(to, content.size(), 4);
  put(to, content.size(), 4);
  put(to, name.size(), 2);
  put(to, 0, 2);  // extra field
}

}  // namespace

std::string zip_archive(const std::vector<std::pair<std::string, std::string>> & files)
{
  std::string archive;
  std::string directory;
  for (const auto & [name, content] : files) {
    const std::size_t offset = archive.size();
    put(archive, local_header, 4);
    put_description(archive, name, content);
    archive += name + content;

    put(directory, directory_entry, 4);
    put(directory, version, 2);
    put_description(directory, name, content);
    put(directory, 0, 2);  // comment
    put(directory, 0, 2);  // disk
    put(directory, 0, 2);  // internal attributes
    put(directory, 0, 4);  // external attributes
    put(directory, offset, 4);
    directory += name;
  }
  const std::size_t begin = archive.size();
  archive += directory;
  put(archive, end_of_directory, 4);
  put(archive, 0, 4);  // disks
  put(archive, files.size(), 2);
  put(archive, files.size(), 2);
  put(archive, directory.size(), 4);
  put(archive, begin, 4);
  put(archive, 0, 2);  // comment
  return archive;
}

}  // namespace ur_simulator
