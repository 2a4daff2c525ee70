#include <stdexcept>

#include "input.hpp"
#include "world_file/world_file.hpp"

// The content of a world file (YAML), as given with --world.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  const std::string text(ur_fuzz::Input(data, size).take_piece(0));
  try {
    double time = 0.0;
    for (const auto & event : ur_simulator::parse_world_file(text, "cell.yaml").events) {
      if (!(event.time >= time) || event.origin.empty() || !event.action) {
        __builtin_trap();
      }
      time = event.time;
    }
  } catch (const std::runtime_error &) {  // states the line of the error
  }
  return 0;
}
