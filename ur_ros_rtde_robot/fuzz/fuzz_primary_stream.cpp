#include <span>

#include "connection/primary_connection.hpp"
#include "input.hpp"

// The byte stream of the primary interface, in pieces.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  ur_fuzz::Input input(data, size);
  const std::size_t piece = input.take_option();
  ur_ros_rtde::PrimaryReader reader;
  while (!input.empty() && reader.feed(std::as_bytes(std::span(input.take_piece(piece))))) {
    while (reader.next()) {
    }
  }
  return 0;
}
