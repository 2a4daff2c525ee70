#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "log/event_log.hpp"
#include "motion/arm.hpp"
#include "script_api/robot_library.hpp"
#include "state/controller_state.hpp"
#include "urscript/host.hpp"
#include "urscript/machine.hpp"

namespace ur_simulator {

/// Where the runner works. Everything outlives it.
struct ProgramAccess {
  ControllerState & state;
  Arm & arm;
  Watchdog & watchdog;
  EventLog & log;
  std::shared_ptr<const urscript::Library> library;
  double cycle_time;  ///< s
};

/// Runs the robot's program, and `sec` programs beside it; owns the runtime state.
class ProgramRunner final : public urscript::Host {
 public:
  explicit ProgramRunner(const ProgramAccess & access);

  tl::expected<urscript::Program, urscript::CompileError> compile(std::string_view text) const;
  /// Starts the program in place of the running one, or beside it when it is a `sec` program.
  void start(urscript::Program program);
  /// Ends the program; the arm decelerates.
  void stop(std::string_view why);
  /// A fault on demand: the program is gone, and nothing says so. False when none runs.
  bool kill();
  /// Ends all programs at once, `sec` programs too (the controller switches off).
  void shut_down();
  /// Ramp down and wait, or go on; false when no program runs (is paused).
  bool pause();
  bool resume();
  /// One control cycle of all programs.
  void cycle();

  bool running() const { return primary_ != nullptr; }
  bool paused() const;
  /// The name after `def` of the program that runs or ran last.
  const std::string & name() const { return name_; }
  const urscript::Machine * machine() const { return primary_.get(); }

  const std::optional<urscript::Popup> & popup() const { return popup_; }
  void close_popup() { popup_.reset(); }

  void text_message(const std::string & text) override;
  void show_popup(const urscript::Popup & popup) override;
  bool popup_open() const override { return popup_.has_value(); }

 private:
  void start_secondary(std::unique_ptr<urscript::Machine> machine);
  void run_primary();
  void run_secondaries();
  void follow_ramps();
  void end(RuntimeState next);
  void log(LogKind kind, std::string text);

  ProgramAccess access_;
  std::string name_;
  std::unique_ptr<urscript::Machine> primary_;
  std::vector<std::unique_ptr<urscript::Machine>> secondaries_;
  std::optional<urscript::Popup> popup_;
};

}  // namespace ur_simulator
