#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kinematics/robot_model.hpp"
#include "motion/arm.hpp"
#include "script_api/robot_library.hpp"
#include "script_api/script_socket.hpp"
#include "urscript/machine.hpp"
#include "urscript/program.hpp"
#include "world/world.hpp"

// Compiles the input with all builtins and runs it for some cycles on a simulated arm.

namespace {

using namespace ur_simulator;

constexpr double cycle_time = 0.002;  // s
constexpr int cycles = 60;

/// A host that accepts every connection and repeats what the program sends.
class EchoSocket final : public ScriptSocket {
 public:
  bool connected() const override { return true; }
  bool failed() const override { return false; }
  void send(std::string_view bytes) override { received_.append(bytes.substr(0, 1000)); }
  std::string & received() override
  {
    received_.resize(std::min<std::size_t>(received_.size(), 100000));
    return received_;
  }

 private:
  std::string received_ = "(1, 2)\nPOS 3\n";
};

/// An arm that is reset before each program.
class Robot {
 public:
  Robot() : world_(model_, 1)
  {
    reset();
    library_ =
        with_sockets(*make_robot_library({state_, *arm_, world_, model_, watchdog_, {}, cycle_time, nullptr}),
                     [](const std::string &, std::uint16_t) { return std::make_shared<EchoSocket>(); });
  }

  void run(std::string_view text)
  {
    const auto program = urscript::compile(text, *library_);
    if (!program) {
      return;
    }
    reset();
    urscript::MachineOptions options;
    options.infinite_loop_after = 0.05;
    urscript::Machine machine(*program, library_, host_, options);
    for (int i = 0; i < cycles && machine.cycle() == urscript::MachineStatus::running; ++i) {
      arm_->step(state_);
      world_.step(state_);
    }
  }

 private:
  void reset()
  {
    state_ = ControllerState();
    state_.robot_mode = RobotMode::running;
    arm_.emplace(model_, cycle_time, default_position(model_));
    arm_->teleport(default_position(model_), state_);
  }

  const RobotModel & model_ = find_robot_model("ur10e")->get();
  ControllerState state_;
  std::optional<Arm> arm_;
  World world_;
  Watchdog watchdog_;
  urscript::Host host_;
  std::shared_ptr<const urscript::Library> library_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  static Robot robot;
  robot.run({reinterpret_cast<const char *>(data), size});
  return 0;
}
