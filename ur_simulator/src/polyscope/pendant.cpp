#include "polyscope/pendant.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator {
namespace {

constexpr std::string_view pendant_source = "pendant";
constexpr std::string_view folder = "/programs/";

/// The name inside the programs folder: clients give it with and without the folder.
std::string file_name(std::string_view path)
{
  if (path.starts_with(folder)) {
    path.remove_prefix(folder.size());
  }
  return std::string(path);
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
}

void Pendant::store_program(const std::string & name, const std::string & script)
{
  programs_.insert_or_assign(file_name(name), script);
  external_.erase(file_name(name));
}

void Pendant::store_external_control(const std::string & name, const ProgramHost & host)
{
  store_program(name, "");
  external_.insert_or_assign(file_name(name), host);
}

tl::expected<void, Pendant::LoadError> Pendant::load_program(const std::string & name)
{
  const auto found = programs_.find(file_name(name));
  if (found == programs_.end()) {
    return tl::make_unexpected(LoadError::not_found);
  }
  const bool fetched = external_.contains(found->first);
  if (const auto compiled = runner_.compile(found->second); !fetched && !compiled) {
    log_.error(pendant_source, fmt::format("'{}' cannot be loaded: {}", name, compiled.error().text()));
    return tl::make_unexpected(LoadError::not_a_program);
  }
  runner_.stop("another program was loaded");
  loaded_ = found->first;
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

Pendant::Answer Pendant::can_run() const
{
  if (state_.robot_mode != RobotMode::running) {
    return tl::make_unexpected(
        fmt::format("robot mode is {}, a program needs RUNNING", to_string(state_.robot_mode)));
  }
  const bool safe = state_.safety_mode == SafetyMode::normal || state_.safety_mode == SafetyMode::reduced ||
                    state_.safety_mode == SafetyMode::recovery;
  if (!safe) {
    return tl::make_unexpected(
        fmt::format("safety mode is {}, a program needs NORMAL or REDUCED", to_string(state_.safety_mode)));
  }
  return {};
}

Pendant::Answer Pendant::start(std::string_view script)
{
  auto program = runner_.compile(script);
  if (!program) {
    return tl::make_unexpected(program.error().text());
  }
  return start(std::move(*program), script);
}

Pendant::Answer Pendant::start(urscript::Program program, std::string_view script)
{
  const bool secondary = program.secondary();
  if (const Answer can = can_run(); !secondary && !can) {
    return can;
  }
  runner_.start(std::move(program));
  if (!secondary) {
    last_script_ = script;
  }
  return {};
}

Pendant::Answer Pendant::run_script(std::string_view text)
{
  Answer answer;
  if (!remote_control_ && options_.version.is_e_series()) {
    answer = tl::make_unexpected(std::string("the robot is in local control: switch it to remote control"));
  } else if (manual()) {
    answer = tl::make_unexpected(std::string("the operational mode is MANUAL: set it to automatic"));
  } else {
    auto program = runner_.compile(text);
    if (!program) {
      const urscript::CompileError & error = program.error();
      log_.add(LogLevel::error, "program", "script was not started: " + error.text(), error.line,
               error.column);
      return tl::make_unexpected(error.text());
    }
    answer = start(std::move(*program), text);
  }
  if (!answer) {
    log_.error("program", "script was not started: " + answer.error());
  }
  return answer;
}

void Pendant::play(const std::function<void(const Answer &)> & done)
{
  const auto host = external_.find(loaded_);
  const Answer can = can_run();
  if (runner_.running() || host == external_.end() || !fetch_ || !can) {
    done(play_now());
    return;
  }
  if (fetching_) {
    done(tl::make_unexpected(std::string("the program is being fetched already")));
    return;
  }
  fetching_ = true;
  fetch_(host->second,
         [this, done, from = host->second](const tl::expected<std::string, std::string> & text) {
           fetching_ = false;
           done(play_fetched(from, text));
         });
}

Pendant::Answer Pendant::play_fetched(const ProgramHost & host,
                                      const tl::expected<std::string, std::string> & text)
{
  std::string script = "def external_control():\n";
  if (text) {
    script += text.value();
  } else {
    // What the URCap puts in the place of a program that it could not get.
    script += fmt::format(
        "popup(\"The connection to the remote PC at {}:{} could not be established. Reason: {}\", \"Receive "
        "program failed\", False, True, blocking=True)\nsync()",
        host.address, host.port, text.error());
    log_.error(pendant_source,
               fmt::format("no program from {}:{}: {}", host.address, host.port, text.error()));
  }
  const Answer answer = start(script + "\nend\n");
  if (!answer) {
    log_.error(pendant_source, "play was refused: " + answer.error());
  }
  return answer;
}

Pendant::Answer Pendant::play_now()
{
  Answer answer = can_run();
  if (answer && runner_.running()) {
    answer = runner_.resume() ? Answer() : tl::make_unexpected(std::string("the program is running already"));
  } else if (answer) {
    const std::string script = loaded_.empty() ? last_script_ : programs_.at(loaded_);
    answer = script.empty() ? tl::make_unexpected(std::string("no program is loaded")) : start(script);
  }
  if (!answer) {
    log_.error(pendant_source, "play was refused: " + answer.error());
  }
  return answer;
}

Pendant::Answer Pendant::pause()
{
  if (!runner_.pause()) {
    return tl::make_unexpected(std::string("no program is running"));
  }
  return {};
}

void Pendant::stop()
{
  runner_.stop("stopped by the operator");
}

Pendant::Answer Pendant::logged(std::string_view action, const SafetyAnswer & answer)
{
  if (!answer) {
    log_.error(pendant_source, fmt::format("{} was refused: {}", action, answer.error()));
  }
  return answer;
}

Pendant::Answer Pendant::power_on()
{
  return logged("power on", safety_.power_on());
}

Pendant::Answer Pendant::power_off()
{
  return logged("power off", safety_.power_off());
}

Pendant::Answer Pendant::release_brakes()
{
  return logged("brake release", safety_.brake_release());
}

Pendant::Answer Pendant::unlock_protective_stop()
{
  Answer answer = logged("unlock protective stop", safety_.unlock_protective_stop());
  if (answer) {
    safety_popup_.reset();
  }
  return answer;
}

Pendant::Answer Pendant::restart_safety()
{
  return logged("restart safety", safety_.restart_safety());
}

void Pendant::set_remote_control(bool remote)
{
  remote_control_ = remote;
  log_.info(pendant_source, remote ? "remote control" : "local control");
}

}  // namespace ur_simulator
