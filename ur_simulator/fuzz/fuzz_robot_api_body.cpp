#include "input.hpp"
#include "robot_api/multipart.hpp"
#include "robot_api/program_file.hpp"

// The content of a request to the Robot API: after its first line, which is the content type, a form with a
// program file; or such a file.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  using namespace ur_simulator::robot_api;
  ur_fuzz::Input input(data, size);
  const bool is_form = input.take_option() % 2 == 0;
  std::string document;
  if (is_form) {
    const std::string_view content_type = input.take_line();
    document = form_field(content_type, input.take_piece(0), "file").value_or("");
  } else {
    document = input.take_piece(0);
  }
  if (const auto file = read_program_file(document)) {
    (void)program_document(file->name, file->program);
  }
  return 0;
}
