#include "polyscope/zip_file.hpp"

#include <boost/crc.hpp>
#include <cstdint>

namespace ur_simulator {
namespace {

constexpr std::uint32_t local_file_header_signature = 0x04034b50;
constexpr std::uint32_t central_directory_header_signature = 0x02014b50;
constexpr std::uint32_t end_of_central_directory_signature = 0x06054b50;
constexpr std::uint16_t version = 20;      // version 2.0 of the format
constexpr std::uint16_t dos_epoch = 0x21;  // 1 January 1980; modification times are not stored

void put_little_endian(std::string & to, std::uint64_t value, int bytes)
{
  for (int i = 0; i < bytes; ++i) {
    to += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

/// Writes the fields that the local file header and the central directory header have in common.
void put_file_description(std::string & to, const std::string & name, const std::string & content)
{
  boost::crc_32_type crc;
  crc.process_bytes(content.data(), content.size());
  put_little_endian(to, version, 2);
  put_little_endian(to, 0, 2);  // flags
  put_little_endian(to, 0, 2);  // compression method: stored
  put_little_endian(to, 0, 2);  // time
  put_little_endian(to, dos_epoch, 2);
  put_little_endian(to, crc.checksum(), 4);
  put_little_endian(to, content.size(), 4);
  put_little_endian(to, content.size(), 4);
  put_little_endian(to, name.size(), 2);
  put_little_endian(to, 0, 2);  // extra field
}

}  // namespace

std::string zip_archive(const std::vector<std::pair<std::string, std::string>> & files)
{
  std::string archive;
  std::string central_directory;
  for (const auto & [name, content] : files) {
    const std::size_t offset = archive.size();
    put_little_endian(archive, local_file_header_signature, 4);
    put_file_description(archive, name, content);
    archive += name + content;

    put_little_endian(central_directory, central_directory_header_signature, 4);
    put_little_endian(central_directory, version, 2);
    put_file_description(central_directory, name, content);
    put_little_endian(central_directory, 0, 2);  // comment
    put_little_endian(central_directory, 0, 2);  // disk
    put_little_endian(central_directory, 0, 2);  // internal attributes
    put_little_endian(central_directory, 0, 4);  // external attributes
    put_little_endian(central_directory, offset, 4);
    central_directory += name;
  }
  const std::size_t central_directory_offset = archive.size();
  archive += central_directory;
  put_little_endian(archive, end_of_central_directory_signature, 4);
  put_little_endian(archive, 0, 4);  // disks
  put_little_endian(archive, files.size(), 2);
  put_little_endian(archive, files.size(), 2);
  put_little_endian(archive, central_directory.size(), 4);
  put_little_endian(archive, central_directory_offset, 4);
  put_little_endian(archive, 0, 2);  // comment
  return archive;
}

}  // namespace ur_simulator
