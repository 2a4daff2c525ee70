#include "input.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "script_api/program_sockets.hpp"
#include "script_api/robot_library.hpp"
#include "script_api/watchdog.hpp"
#include "urscript/program.hpp"
#include "urscript/script_reader.hpp"
#include "world/world.hpp"

// Extracts programs from the bytes of a script port and compiles the input with all builtins. Nothing runs:
// that is the target `urscript`.

namespace {

using namespace ur_simulator;

constexpr double cycle_time = 0.002;  // s

/// The builtins, and the robot that they refer to.
struct Builtins {
  const RobotModel & model = find_robot_model("ur10e")->get();
  ControllerState state;
  Arm arm{model, cycle_time, default_position(model)};
  World world{model, 1};
  Watchdog watchdog;
  std::shared_ptr<const urscript::Library> library =
      with_sockets(*make_robot_library({state, arm, world, model, watchdog, {}, cycle_time, nullptr}),
                   [](const std::string &, std::uint16_t) { return nullptr; });
};

void extract_programs(std::string_view bytes)
{
  constexpr std::size_t limit = 256;
  urscript::ScriptReader reader(limit);
  std::size_t returned = 0;
  for (ur_fuzz::Input input(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size());
       !input.empty();) {
    reader.feed(input.take_piece(100));
    while (const auto program = reader.next()) {
      returned += program->size();
    }
  }
  if (returned + reader.pending() > bytes.size()) {
    __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static const Builtins builtins;
  const std::string_view text = ur_fuzz::Input(data, size).take_piece(0);
  (void)urscript::compile(text, *builtins.library);
  extract_programs(text);
  return 0;
}
