#include <array>
#include <cstdlib>

#include "input.hpp"
#include "script/control_script.hpp"
#include "script/program.hpp"
#include "script/scan.hpp"

// Scripts and extensions of users, which the driver completes before it sends them. The parts of the input
// are separated by the byte 1.

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

std::array<std::string, 5> split(std::string_view text)
{
  std::array<std::string, 5> parts;
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

void add_extensions(const std::array<std::string, 5> & parts)
{
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
  for (const auto & [major, minor] : {std::pair(5U, 10U), std::pair(5U, 25U), std::pair(3U, 15U)}) {
    const auto sent = script::for_controller(*script, major, minor, minor == 25);
    for (int line = 0; sent && line < 200; ++line) {
      (void)script::place(*sent, line);
    }
  }
}

void make_program(const std::string & script)
{
  for (const bool secondary : {false, true}) {
    const auto program = script::make_program(script, {secondary, "begin", "end", "a = 1"});
    // What is sent is one program, also if the script tries to end it early.
    if (program) {
      const auto scanned = script::scan(program->text.text());
      require(scanned && !scanned->tokens.empty());
      require(scanned->tokens.front().is(secondary ? "sec" : "def"));
      require(scanned->block_from(0)->last + 1 == scanned->tokens.size());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  const auto parts = split(ur_fuzz::Input(data, size).take_piece(0));
  add_extensions(parts);
  make_program(parts[4]);
  return 0;
}
