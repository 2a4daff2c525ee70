#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "kinematics/robot_model.hpp"
#include "log/event_log.hpp"
#include "polyscope/program_runner.hpp"
#include "polyscope/report_writer.hpp"
#include "polyscope/stored_program.hpp"
#include "safety/safety.hpp"
#include "state/controller_state.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator {

struct PendantOptions {
  PolyscopeVersion version;
  bool remote_control = true;
  std::string serial_number = "20245000001";
  std::string reports_folder;
};

/// The operator's functions of PolyScope: programs, power, safety, modes and popups. The dashboard server,
/// the Robot API, the client interfaces and the control port use them.
class Pendant {
 public:
  /// Success, or the reason for the rejection.
  using Result = tl::expected<void, std::string>;
  enum class LoadError { not_found, does_not_compile };

  Pendant(const RobotModel & model, const PendantOptions & options, ControllerState & state, Safety & safety,
          ProgramRunner & runner, EventLog & log);

  // ---- programs

  /// Stores a program on the controller's disk. A name that ends in ".installation" is an installation.
  void store_program(const std::string & name, StoredProgram program);
  tl::expected<void, LoadError> load_program(const std::string & name);
  /// Returns false if there is no such installation.
  bool load_installation(const std::string & name);
  /// Runs a script received on a client interface, which replaces the running program, or executes a
  /// controller command such as `power on`.
  Result run_script(std::string_view text);
  /// How long the compilation of such a script takes, s. It begins afterwards. 0: at once.
  void set_compile_time(double time) { compile_time_ = time; }
  /// Resumes a paused program. Otherwise starts the loaded program or, without one, the last received script.
  /// `done` receives the result: before the function returns, or later if the program is requested from a
  /// host.
  void play(const std::function<void(const Result &)> & done);
  Result pause();
  Result resume();
  void stop();

  using ProgramText = tl::expected<std::string, std::string>;
  /// Requests the program of a host. `done` receives the program, or the reason why there is none.
  using ProgramRequest =
      std::function<void(const ProgramHost & host, std::function<void(const ProgramText &)> done)>;
  void set_program_request(ProgramRequest request) { request_program_ = std::move(request); }

  const std::string & loaded_program() const { return loaded_program_; }
  /// Returns nullptr if there is no such program.
  const StoredProgram * find_program(const std::string & name) const;
  /// The programs on the controller's disk by name.
  const std::map<std::string, StoredProgram> & programs() const { return programs_; }
  const std::string & installation() const { return installation_; }

  // ---- power and safety

  Result power_on();
  Result power_off();
  Result release_brakes();
  Result unlock_protective_stop(UnlockDelay delay = UnlockDelay::required);
  Result restart_safety();
  bool restarting_safety() const { return safety_.restarting(); }
  void close_safety_popup() { safety_popup_.reset(); }
  void show_safety_popup(std::string text) { safety_popup_ = std::move(text); }
  const std::optional<std::string> & safety_popup() const { return safety_popup_; }

  /// Forgets what is not on the disk: the loaded program, the last script, modes and popups.
  void reboot();
  /// Requests that the controller switches itself off.
  void request_shutdown() { shutdown_requested_ = true; }
  /// Returns whether a shutdown was requested since the last call.
  bool take_shutdown_request() { return std::exchange(shutdown_requested_, false); }

  // ---- modes

  /// Sets the speed slider, 0..1.
  void set_speed_slider(double fraction) { state_.speed_slider = fraction; }
  bool remote_control() const { return remote_control_; }
  /// PolyScope X rejects remote control in manual mode.
  Result set_remote_control(bool remote);
  /// Sets the operational mode: "MANUAL" or "AUTOMATIC"; nullopt: PolyScope 5 no longer controls it. With
  /// PolyScope X, manual mode ends remote control.
  void set_operational_mode(std::optional<std::string> mode);
  /// Programs cannot be started remotely.
  bool in_manual_mode() const { return operational_mode_ == "MANUAL"; }

  /// "MANUAL" or "AUTOMATIC", if it has been set.
  const std::optional<std::string> & operational_mode() const { return operational_mode_; }
  static constexpr std::string_view default_user_role = "PROGRAMMER";
  /// CB3 only: "PROGRAMMER", "OPERATOR", "NONE", "LOCKED" or "RESTRICTED".
  std::string user_role{default_user_role};

  ReportWriter & reports() { return reports_; }
  const RobotModel & model() const { return model_; }
  const PendantOptions & options() const { return options_; }
  const ControllerState & state() const { return state_; }
  ProgramRunner & runner() { return runner_; }
  const ProgramRunner & runner() const { return runner_; }
  EventLog & log() { return log_; }

 private:
  Result check_can_run() const;
  Result start(std::string_view script);
  Result start(urscript::Program program, std::string_view script, double delay = 0.0);
  Result resume_or_start_program();
  Result start_external_program(const StoredProgram & program, const ProgramText & text);
  void log_compile_error(const urscript::CompileError & error);
  /// Logs why a script was not started.
  Result reject_script(Result reason);
  /// Logs the reason if the action was rejected.
  Result log_rejection(std::string_view action, Result result);

  const RobotModel & model_;
  PendantOptions options_;
  ControllerState & state_;
  Safety & safety_;
  ProgramRunner & runner_;
  EventLog & log_;
  bool remote_control_;
  double compile_time_ = 0.0;
  std::optional<std::string> operational_mode_;
  bool shutdown_requested_ = false;
  std::map<std::string, StoredProgram> programs_;
  ProgramRequest request_program_;
  bool program_requested_ = false;
  ReportWriter reports_;
  std::string loaded_program_;
  std::string last_script_;
  std::string installation_ = "default.installation";
  std::optional<std::string> safety_popup_;
};

}  // namespace ur_simulator
