#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "kinematics/robot_model.hpp"
#include "log/event_log.hpp"
#include "polyscope/program_runner.hpp"
#include "polyscope/report_writer.hpp"
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

/// Where the External Control URCap fetches its program.
struct ProgramHost {
  std::string address;
  std::uint16_t port = 50002;
};

/// What a person at the teach pendant, or a program on its behalf, does with the robot: the part of PolyScope
/// that stands above controller and safety system. The dashboard server, the script ports and the control
/// port all act through it.
class Pendant {
 public:
  /// Refusals say why.
  using Answer = tl::expected<void, std::string>;
  enum class LoadError { not_found, not_a_program };

  Pendant(const RobotModel & model, const PendantOptions & options, ControllerState & state, Safety & safety,
          ProgramRunner & runner, EventLog & log);

  /// Puts a program on the controller's disk, as one made on the pendant would be. A name that ends in
  /// ".installation" is an installation.
  void store_program(const std::string & name, const std::string & script);
  /// One that consists of the External Control URCap's node.
  void store_external_control(const std::string & name, const ProgramHost & host);
  tl::expected<void, LoadError> load_program(const std::string & name);
  bool load_installation(const std::string & name);
  /// A script from one of the script ports: runs at once, in place of what runs.
  Answer run_script(std::string_view text);
  /// Starts the loaded program (without one: the last script received), or goes on with a paused one. `done`
  /// is told when it runs, or why it does not: at once, unless the program is fetched from a host first.
  void play(const std::function<void(const Answer &)> & done);
  Answer pause();
  void stop();

  Answer power_on();
  Answer power_off();
  Answer release_brakes();
  Answer unlock_protective_stop();
  Answer restart_safety();
  void close_safety_popup() { safety_popup_.reset(); }
  void show_safety_popup(std::string text) { safety_popup_ = std::move(text); }
  const std::optional<std::string> & safety_popup() const { return safety_popup_; }

  /// Asks a host for its program; `done` gets it, or why there is none.
  using Fetch = std::function<void(const ProgramHost & host,
                                   std::function<void(const tl::expected<std::string, std::string> &)> done)>;
  void fetch_programs_by(Fetch fetch) { fetch_ = std::move(fetch); }

  /// The operational mode that the dashboard set is manual: nothing is started from afar.
  bool manual() const { return operational_mode == "MANUAL"; }
  ReportWriter & reports() { return reports_; }

  bool remote_control() const { return remote_control_; }
  void set_remote_control(bool remote);

  /// "MANUAL" or "AUTOMATIC" while the dashboard controls it.
  std::optional<std::string> operational_mode;
  /// CB3 only: "PROGRAMMER", "OPERATOR", "NONE", "LOCKED", "RESTRICTED".
  std::string user_role = "PROGRAMMER";

  const std::string & loaded_program() const { return loaded_; }
  const std::string & installation() const { return installation_; }
  /// Set by shutdown(): the controller switches off.
  bool shutdown_requested() const { return shutdown_; }
  void request_shutdown(bool shutdown) { shutdown_ = shutdown; }

  const RobotModel & model() const { return model_; }
  const PendantOptions & options() const { return options_; }
  const ControllerState & state() const { return state_; }
  ProgramRunner & runner() { return runner_; }
  EventLog & log() { return log_; }

 private:
  Answer can_run() const;
  Answer start(std::string_view script);
  Answer start(urscript::Program program, std::string_view script);
  Answer play_now();
  Answer play_fetched(const ProgramHost & host, const tl::expected<std::string, std::string> & text);
  Answer logged(std::string_view action, const SafetyAnswer & answer);

  const RobotModel & model_;
  PendantOptions options_;
  ControllerState & state_;
  Safety & safety_;
  ProgramRunner & runner_;
  EventLog & log_;
  bool remote_control_;
  bool shutdown_ = false;
  std::map<std::string, std::string> programs_;
  std::map<std::string, ProgramHost> external_;  ///< those of programs_ that are fetched
  Fetch fetch_;
  bool fetching_ = false;
  ReportWriter reports_;
  std::string loaded_;
  std::string last_script_;
  std::string installation_ = "default.installation";
  std::optional<std::string> safety_popup_;
};

}  // namespace ur_simulator
