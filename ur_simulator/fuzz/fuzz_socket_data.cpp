#include <array>

#include "input.hpp"
#include "script_api/socket_extractors.hpp"

// What a host sends to a program that reads it with socket_read_… or socket_get_var, in pieces.

namespace {

using namespace ur_simulator::script_api;

constexpr std::size_t count = 3;  // of the numbers in one read

const std::array<Extractor, 8> & extractors()
{
  static const std::array<Extractor, 8> all{line_extractor(),
                                            string_extractor("", ""),
                                            string_extractor("<", ">"),
                                            string_extractor("begin", "end"),
                                            integer_extractor(count, 1),
                                            integer_extractor(count, 4),
                                            float_extractor(count),
                                            variable_extractor("POS")};
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  ur_fuzz::Input input(data, size);
  const Extractor & extract = extractors()[input.take_option() % extractors().size()];
  const std::size_t piece = input.take_option();
  std::string received;
  while (!input.empty()) {
    received += input.take_piece(piece);
    for (std::size_t before = received.size(); extract(received); before = received.size()) {
      if (received.size() >= before) {  // would be read for ever
        __builtin_trap();
      }
    }
  }
  (void)interpret_escapes(received);
  return 0;
}
