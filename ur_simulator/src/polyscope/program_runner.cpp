#include "polyscope/program_runner.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator {
namespace {

constexpr std::string_view program_source = "program";
constexpr std::size_t most_secondaries = 16;
constexpr double stood_still = 1e-3;  // speed scaling below which a paused trajectory counts as standing

}  // namespace

ProgramRunner::ProgramRunner(const ProgramAccess & access) : access_(access) {}

tl::expected<urscript::Program, urscript::CompileError> ProgramRunner::compile(std::string_view text) const
{
  return urscript::compile(text, *access_.library);
}

void ProgramRunner::start(urscript::Program program)
{
  urscript::MachineOptions options;
  options.cycle_time = access_.cycle_time;
  auto machine = std::make_unique<urscript::Machine>(std::move(program), access_.library, *this, options);
  if (machine->program().secondary()) {
    start_secondary(std::move(machine));
    return;
  }
  stop("another program was started");
  access_.arm.resume();
  name_ = machine->program().name();
  primary_ = std::move(machine);
  access_.state.runtime_state = RuntimeState::playing;
  log(LogKind::program_started, fmt::format("program '{}' started", name_));
}

void ProgramRunner::start_secondary(std::unique_ptr<urscript::Machine> machine)
{
  if (secondaries_.size() == most_secondaries) {
    access_.log.error(program_source, fmt::format("{} secondary programs run already: '{}' was not started",
                                                  most_secondaries, machine->program().name()));
    return;
  }
  secondaries_.push_back(std::move(machine));
}

void ProgramRunner::stop(std::string_view why)
{
  if (!primary_) {
    return;
  }
  primary_->stop();
  log(LogKind::program_ended, fmt::format("program '{}' stopped: {}", name_, why));
  end(RuntimeState::stopping);
}

void ProgramRunner::log(LogKind kind, std::string text)
{
  LogEntry entry;
  entry.source = program_source;
  entry.text = std::move(text);
  entry.kind = kind;
  entry.title = name_;
  access_.log.add(std::move(entry));
}

bool ProgramRunner::kill()
{
  if (!primary_) {
    return false;
  }
  primary_->stop();
  end(RuntimeState::stopped);
  return true;
}

void ProgramRunner::shut_down()
{
  stop("the controller switches off");
  secondaries_.clear();
  popup_.reset();
}

void ProgramRunner::end(RuntimeState next)
{
  primary_.reset();
  popup_.reset();
  access_.watchdog.clear();
  access_.state.runtime_state = next;
  access_.arm.end_program();
  access_.arm.resume();
}

bool ProgramRunner::paused() const
{
  const RuntimeState now = access_.state.runtime_state;
  return now == RuntimeState::paused || now == RuntimeState::pausing;
}

bool ProgramRunner::pause()
{
  if (!primary_) {
    return false;
  }
  if (!paused()) {
    access_.state.runtime_state = RuntimeState::pausing;
    access_.arm.pause();
  }
  return true;
}

bool ProgramRunner::resume()
{
  if (!primary_ || !paused()) {
    return false;
  }
  access_.state.runtime_state = RuntimeState::resuming;
  access_.arm.resume();
  return true;
}

void ProgramRunner::cycle()
{
  follow_ramps();
  if (primary_ && !paused()) {
    run_primary();
  }
  run_secondaries();
}

void ProgramRunner::follow_ramps()
{
  RuntimeState & runtime = access_.state.runtime_state;
  if (runtime == RuntimeState::pausing &&
      (access_.arm.at_rest() || access_.state.speed_scaling < stood_still)) {
    runtime = RuntimeState::paused;
  } else if (runtime == RuntimeState::resuming) {
    runtime = RuntimeState::playing;
  } else if (runtime == RuntimeState::stopping && access_.arm.at_rest()) {
    runtime = RuntimeState::stopped;
  }
}

void ProgramRunner::run_primary()
{
  switch (primary_->cycle()) {
    case urscript::MachineStatus::running:
      return;
    case urscript::MachineStatus::finished:
      log(LogKind::program_ended, fmt::format("program '{}' ended", name_));
      break;
    case urscript::MachineStatus::failed:
      access_.log.add(LogLevel::error, program_source,
                      fmt::format("program '{}' failed in line {}: {}", name_, primary_->error().line,
                                  primary_->error().message),
                      primary_->error().line);
      break;
  }
  end(RuntimeState::stopping);
}

void ProgramRunner::run_secondaries()
{
  std::erase_if(secondaries_, [this](const std::unique_ptr<urscript::Machine> & machine) {
    const urscript::MachineStatus status = machine->cycle();
    if (status == urscript::MachineStatus::failed) {
      access_.log.add(LogLevel::error, program_source,
                      fmt::format("secondary program '{}' failed in line {}: {}", machine->program().name(),
                                  machine->error().line, machine->error().message),
                      machine->error().line);
    }
    return status != urscript::MachineStatus::running;
  });
}

void ProgramRunner::text_message(const std::string & text)
{
  access_.log.info("textmsg", text);
}

void ProgramRunner::show_popup(const urscript::Popup & popup)
{
  popup_ = popup;
  LogEntry entry;
  entry.level = popup.error ? LogLevel::error : popup.warning ? LogLevel::warning : LogLevel::info;
  entry.source = "popup";
  entry.text = fmt::format("{}: {}", popup.title, popup.message);
  entry.kind = LogKind::popup;
  entry.title = popup.title;
  entry.blocking = popup.blocking;
  access_.log.add(std::move(entry));
}

}  // namespace ur_simulator
