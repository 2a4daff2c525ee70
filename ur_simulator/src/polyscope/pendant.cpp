#include "polyscope/pendant.hpp"

#include <fmt/format.h>

#include <utility>

#include "polyscope/controller_commands.hpp"

namespace ur_simulator {
namespace {

constexpr std::string_view pendant_source = "pendant";
constexpr std::string_view script_source = "program";
constexpr std::string_view default_program = "Default program";  // of PolyScope X
constexpr std::string_view programs_folder_prefix = "/programs/";

/// The name within the programs folder. Clients give it with or without the folder.
std::string file_name(std::string_view path)
{
  if (path.starts_with(programs_folder_prefix)) {
    path.remove_prefix(programs_folder_prefix.size());
  }
  return std::string(path);
}

/// The program that the External Control URCap substitutes for a program that it could not receive (source
/// code of the URCap, Universal_Robots_ExternalControl_URCap).
std::string receive_failed_popup(const ProgramHost & host, const std::string & reason)
{
  return fmt::format(
      "popup(\"The connection to the remote PC at {}:{} could not be established. Reason: {}\", \"Receive "
      "program failed\", False, True, blocking=True)\nsync()",
      host.address, host.port, reason);
}

/// The text of the runtime exception message; "" for errors of which the text on a robot is not known.
std::string exception_text(const urscript::CompileError & error)
{
  if (!error.undefined_name.empty()) {
    return fmt::format("compile_error_name_not_found:{}:", error.undefined_name);
  }
  constexpr std::size_t longest_line = 500;
  return error.source_line ? fmt::format("syntax_error_on_line:{}:{}:", error.line,
                                         std::string_view(*error.source_line).substr(0, longest_line))
                           : "";
}

tl::unexpected<std::string> rejection(std::string reason)
{
  return tl::make_unexpected(std::move(reason));
}

}  // namespace

Pendant::Pendant(const RobotModel & model, const PendantOptions & options, ControllerState & state,
                 Safety & safety, ProgramRunner & runner, EventLog & log)
    : model_(model),
      options_(options),
      state_(state),
      safety_(safety),
      runner_(runner),
      log_(log),
      remote_control_(options.remote_control),
      reports_(state, log, options.serial_number, options.reports_folder)
{
  if (options_.version.is_polyscope_x()) {
    store_program(std::string(default_program), {.script = "def default_program():\nend\n"});
  }
  reboot();
}

void Pendant::reboot()
{
  loaded_program_ = options_.version.is_polyscope_x() ? default_program : "";
  last_script_.clear();
  operational_mode_.reset();
  safety_popup_.reset();
  user_role = default_user_role;
}

// ---- stored programs

void Pendant::store_program(const std::string & name, StoredProgram program)
{
  programs_.insert_or_assign(file_name(name), std::move(program));
}

const StoredProgram * Pendant::find_program(const std::string & name) const
{
  const auto found = programs_.find(file_name(name));
  return found == programs_.end() ? nullptr : &found->second;
}

tl::expected<void, Pendant::LoadError> Pendant::load_program(const std::string & name)
{
  const StoredProgram * program = find_program(name);
  if (program == nullptr) {
    return tl::make_unexpected(LoadError::not_found);
  }
  if (const auto compiled = runner_.compile(program->script); !program->external_control && !compiled) {
    log_.error(pendant_source, fmt::format("'{}' cannot be loaded: {}", name, compiled.error().text()));
    return tl::make_unexpected(LoadError::does_not_compile);
  }
  runner_.stop("another program was loaded");
  loaded_program_ = file_name(name);
  return {};
}

bool Pendant::load_installation(const std::string & name)
{
  const std::string file = file_name(name);
  if (file != installation_ && !(file.ends_with(".installation") && programs_.contains(file))) {
    return false;
  }
  runner_.stop("an installation was loaded");
  installation_ = file;
  return true;
}

// ---- running programs

Pendant::Result Pendant::check_can_run() const
{
  if (state_.robot_mode != RobotMode::running) {
    return rejection(fmt::format("robot mode is {}, a program needs RUNNING", to_string(state_.robot_mode)));
  }
  if (!allows_motion(state_.safety_mode)) {
    return rejection(
        fmt::format("safety mode is {}, a program needs NORMAL or REDUCED", to_string(state_.safety_mode)));
  }
  return {};
}

Pendant::Result Pendant::start(std::string_view script)
{
  auto program = runner_.compile(script);
  if (!program) {
    return rejection(program.error().text());
  }
  return start(std::move(*program), script);
}

Pendant::Result Pendant::start(urscript::Program program, std::string_view script, double delay)
{
  const bool secondary = program.is_secondary();
  if (Result can_run = check_can_run(); !secondary && !can_run) {
    return can_run;
  }
  if (delay > 0.0) {
    runner_.start_later(std::move(program), delay);
  } else {
    runner_.start(std::move(program));
  }
  if (!secondary) {
    last_script_ = script;
  }
  return {};
}

Pendant::Result Pendant::run_script(std::string_view text)
{
  if (!remote_control_ && options_.version.is_e_series()) {
    log_.error(script_source, error_codes::read_only_interface,
               "script was not started: the robot is in local control: switch it to remote control");
    return rejection("the robot is in local control");
  }
  if (const auto result = execute_controller_command(*this, text)) {
    return *result;
  }
  if (in_manual_mode()) {
    return reject_script(rejection("the operational mode is MANUAL: set it to automatic"));
  }
  auto program = runner_.compile(text);
  if (!program) {
    log_compile_error(program.error());
    return rejection(program.error().text());
  }
  Result started = start(std::move(*program), text, compile_time_);
  return started ? started : reject_script(std::move(started));
}

void Pendant::log_compile_error(const urscript::CompileError & error)
{
  LogEntry entry;
  entry.level = LogLevel::error;
  entry.source = script_source;
  entry.text = "script was not started: " + error.text();
  entry.line = error.line;
  entry.column = error.column;
  entry.exception = exception_text(error);
  log_.add(std::move(entry));
}

Pendant::Result Pendant::reject_script(Result reason)
{
  log_.error(script_source, "script was not started: " + reason.error());
  return reason;
}

void Pendant::play(const std::function<void(const Result &)> & done)
{
  const StoredProgram * loaded = find_program(loaded_program_);
  const bool external = loaded != nullptr && loaded->external_control;
  if (runner_.running() || !external || !request_program_ || !check_can_run()) {
    done(log_rejection("play", resume_or_start_program()));
    return;
  }
  if (program_requested_) {
    done(rejection("the program has already been requested from its host"));
    return;
  }
  program_requested_ = true;
  const StoredProgram program = *loaded;
  request_program_(*program.external_control, [this, done, program](const ProgramText & text) {
    program_requested_ = false;
    done(log_rejection("play", start_external_program(program, text)));
  });
}

Pendant::Result Pendant::start_external_program(const StoredProgram & program, const ProgramText & text)
{
  const ProgramHost & host = *program.external_control;
  if (!text) {
    log_.error(pendant_source,
               fmt::format("no program from {}:{}: {}", host.address, host.port, text.error()));
  }
  const std::string body = text ? text.value() : receive_failed_popup(host, text.error());
  return start("def external_control():\n" + body + "\n" + program.script + "\nend\n");
}

Pendant::Result Pendant::resume_or_start_program()
{
  if (Result can_run = check_can_run(); !can_run) {
    return can_run;
  }
  if (runner_.running()) {
    return runner_.resume() ? Result() : rejection("the program is running already");
  }
  const std::string script = loaded_program_.empty() ? last_script_ : programs_.at(loaded_program_).script;
  return script.empty() ? rejection("no program is loaded") : start(script);
}

Pendant::Result Pendant::pause()
{
  return runner_.pause() ? Result() : rejection("no program is running");
}

Pendant::Result Pendant::resume()
{
  return runner_.resume() ? Result() : rejection("no program is paused");
}

void Pendant::stop()
{
  runner_.stop("stopped by the operator");
}

// ---- power, safety and modes

Pendant::Result Pendant::log_rejection(std::string_view action, Result result)
{
  if (!result) {
    log_.error(pendant_source, fmt::format("{} was rejected: {}", action, result.error()));
  }
  return result;
}

Pendant::Result Pendant::power_on()
{
  return log_rejection("power on", safety_.power_on());
}

Pendant::Result Pendant::power_off()
{
  return log_rejection("power off", safety_.power_off());
}

Pendant::Result Pendant::release_brakes()
{
  return log_rejection("brake release", safety_.brake_release());
}

Pendant::Result Pendant::unlock_protective_stop(UnlockDelay delay)
{
  Result result = log_rejection("unlock protective stop", safety_.unlock_protective_stop(delay));
  if (result) {
    safety_popup_.reset();
    safety_.write(state_);  // a program may follow before the next control cycle
  }
  return result;
}

Pendant::Result Pendant::restart_safety()
{
  return log_rejection("restart safety", safety_.restart_safety());
}

Pendant::Result Pendant::set_remote_control(bool remote)
{
  if (remote && in_manual_mode() && options_.version.is_polyscope_x()) {
    return rejection("the operational mode is MANUAL: remote control needs automatic mode");
  }
  remote_control_ = remote;
  log_.info(pendant_source, remote ? "remote control" : "local control");
  return {};
}

void Pendant::set_operational_mode(std::optional<std::string> mode)
{
  operational_mode_ = std::move(mode);
  if (in_manual_mode() && options_.version.is_polyscope_x()) {
    set_remote_control(false);
  }
}

}  // namespace ur_simulator
