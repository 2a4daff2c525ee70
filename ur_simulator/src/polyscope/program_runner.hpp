#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "log/event_log.hpp"
#include "motion/arm.hpp"
#include "script_api/robot_library.hpp"
#include "state/controller_state.hpp"
#include "urscript/host.hpp"
#include "urscript/machine.hpp"
#include "world/world.hpp"

namespace ur_simulator {

/// The objects that programs act on. They outlive the program runner.
struct ProgramContext {
  ControllerState & state;
  Arm & arm;
  World & world;
  Watchdog & watchdog;
  EventLog & log;
  std::shared_ptr<const urscript::Library> library;
  double cycle_time;  ///< s
};

/// Runs the robot program and its secondary programs (`sec`). Owns the runtime state.
class ProgramRunner final : public urscript::Host {
 public:
  explicit ProgramRunner(const ProgramContext & context);

  tl::expected<urscript::Program, urscript::CompileError> compile(std::string_view text) const;
  /// Starts a program. A secondary program runs in parallel; any other replaces the running program.
  void start(urscript::Program program);
  /// The same after `delay` s, for a script that a controller still compiles: until then, it is no program.
  void start_later(urscript::Program program, double delay);
  /// Stops the program and decelerates the arm. The log reports the reason.
  void stop(std::string_view reason);
  /// Fault injection: ends the program without any message. Returns false if no program is running.
  bool kill();
  /// Stops all programs because the controller switches off.
  void shut_down();
  /// Decelerates the arm and pauses the program. Returns false if no program is running.
  bool pause();
  /// Returns false if no program is paused.
  bool resume();
  /// Runs one control cycle of all programs.
  void cycle();

  /// Whether there is a program, running or paused.
  bool running() const { return program_ != nullptr; }
  bool paused() const;
  /// Name of the current or last program.
  const std::string & program_name() const { return program_name_; }
  /// The machine of the current program, or nullptr.
  const urscript::Machine * machine() const { return program_.get(); }

  const std::optional<urscript::Popup> & popup() const { return popup_; }
  void close_popup() { popup_.reset(); }

  /// The value that the program asks the operator to enter, if it does.
  const urscript::ValueRequest * value_request() const { return request_ ? &request_->request : nullptr; }
  /// Enters the value. Its type must be that of the request.
  void answer_request(urscript::Value value) { request_->answer = std::move(value); }

  void text_message(const std::string & text) override;
  void show_popup(const urscript::Popup & popup) override;
  bool popup_open() const override { return popup_.has_value(); }
  std::optional<std::uint64_t> show_request(const urscript::ValueRequest & request) override;
  std::optional<urscript::Value> take_answer(std::uint64_t number) override;

 private:
  struct OpenRequest {
    std::uint64_t number;
    urscript::ValueRequest request;
    std::optional<urscript::Value> answer;
  };

  struct Compiling {
    urscript::Program program;
    double time_left;  ///< s
  };

  void start_compiled();
  void start_secondary(std::unique_ptr<urscript::Machine> machine);
  void run_program();
  void run_secondary_programs();
  void log_secondary_error(const urscript::Machine & machine);
  /// Completes pausing, resuming and stopping once the arm has reached the corresponding state.
  void update_runtime_state();
  void end_program(RuntimeState next);
  void log(LogKind kind, std::string text);

  ProgramContext context_;
  std::string program_name_;
  std::unique_ptr<urscript::Machine> program_;
  std::vector<std::unique_ptr<urscript::Machine>> secondary_programs_;
  std::vector<Compiling> compiling_;
  std::optional<urscript::Popup> popup_;
  std::optional<OpenRequest> request_;
  std::uint64_t request_count_ = 0;
};

}  // namespace ur_simulator
