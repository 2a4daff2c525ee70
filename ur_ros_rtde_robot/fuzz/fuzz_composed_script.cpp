#include <array>
#include <cstdlib>

#include "input.hpp"
#include "script/control_script.hpp"
#include "script/program.hpp"
#include "script/scan.hpp"

// Scripts and extensions of users, which the driver completes before it sends them. The parts of the
// extensions are separated by the byte 1.

namespace {

using namespace ur_ros_rtde;

constexpr const char * control_script = R"(textmsg("ready")
global offset = 0 # register offset
    def process_cmd(cmd):
$5.10 x = 1
$5.10|3.15 y = 1
    end
# HEADER_END
        while True:
            cmd = rtde_cmd()
            process_cmd(cmd)
        end
)";

std::array<std::string, 4> split(std::string_view text)
{
  std::array<std::string, 4> parts;
  for (std::string & part : parts) {
    part = text.substr(0, text.find('\1'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
  }
  return parts;
}

void require(bool condition)
{
  if (!condition) {
    std::abort();
  }
}

void add_extensions(std::string_view text, unsigned major, unsigned minor)
{
  const auto parts = split(text);
  ScriptExtension first;
  first.name = parts[0];
  first.snippet = parts[1];
  first.preamble = parts[2];
  ScriptExtension second = first;
  second.name += "_2";
  second.snippet = parts[3];
  second.preamble_name = parts[2].substr(0, 1);
  const auto script = script::compose(control_script, {first, second});
  if (!script) {
    return;
  }
  require(script->ids.size() == 2);
  const auto sent = script::for_controller(*script, major, minor, minor == 25);
  for (int line = 0; sent && line < 50; ++line) {
    (void)script::place(*sent, line);
  }
}

void make_program(std::string_view text, bool secondary)
{
  const auto program = script::make_program(std::string(text), {secondary, "begin", "end", "a = 1"});
  // What is sent is one program, even if the script tries to end it early.
  if (program) {
    const auto scanned = script::scan(program->text.text());
    require(scanned && !scanned->tokens.empty());
    require(scanned->tokens.front().is(secondary ? "sec" : "def"));
    require(scanned->block_from(0)->last + 1 == scanned->tokens.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  ur_fuzz::Input input(data, size);
  const unsigned kind = input.take_option() % 5;
  const std::string_view text = input.take_piece(0);
  switch (kind) {
    case 0:
      add_extensions(text, 5, 10);
      break;
    case 1:
      add_extensions(text, 5, 25);
      break;
    case 2:
      add_extensions(text, 3, 15);
      break;
    default:
      make_program(text, kind == 3);
  }
  return 0;
}
