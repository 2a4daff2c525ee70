#include "polyscope/program_runner.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_simulator {
namespace {

constexpr std::string_view program_source = "program";
constexpr std::size_t max_secondary_programs = 16;
constexpr double paused_speed_scaling = 1e-3;  // below this speed scaling a program counts as paused

/// The type in a request value message (UR, "Client Interface").
std::uint8_t requested_type(urscript::Type type)
{
  switch (type) {
    case urscript::Type::boolean:
      return 0;
    case urscript::Type::integer:
      return 1;
    case urscript::Type::floating:
      return 2;
    default:
      return 3;  // string
  }
}

}  // namespace

ProgramRunner::ProgramRunner(const ProgramContext & context) : context_(context) {}

tl::expected<urscript::Program, urscript::CompileError> ProgramRunner::compile(std::string_view text) const
{
  return urscript::compile(text, *context_.library);
}

void ProgramRunner::start(urscript::Program program)
{
  urscript::MachineOptions options;
  options.cycle_time = context_.cycle_time;
  options.clock = [&state = context_.state] { return state.timestamp; };
  auto machine = std::make_unique<urscript::Machine>(std::move(program), context_.library, *this, options);
  if (machine->program().is_secondary()) {
    start_secondary(std::move(machine));
    return;
  }
  stop("another program was started");
  context_.arm.resume();
  context_.arm.begin_program();
  context_.world.begin_program();
  program_name_ = machine->program().name();
  program_ = std::move(machine);
  context_.state.runtime_state = RuntimeState::playing;
  log(LogKind::program_started, fmt::format("program '{}' started", program_name_));
}

void ProgramRunner::start_later(urscript::Program program, double delay)
{
  compiling_.push_back({std::move(program), delay});
}

void ProgramRunner::start_compiled()
{
  for (Compiling & script : compiling_) {
    script.time_left -= context_.cycle_time;
    if (script.time_left <= 0.0) {
      start(std::move(script.program));
    }
  }
  std::erase_if(compiling_, [](const Compiling & script) { return script.time_left <= 0.0; });
}

void ProgramRunner::start_secondary(std::unique_ptr<urscript::Machine> machine)
{
  if (secondary_programs_.size() == max_secondary_programs) {
    context_.log.error(program_source,
                       fmt::format("{} secondary programs are running already: '{}' was not started",
                                   max_secondary_programs, machine->program().name()));
    return;
  }
  secondary_programs_.push_back(std::move(machine));
}

void ProgramRunner::stop(std::string_view reason)
{
  if (!program_) {
    return;
  }
  program_->stop();
  log(LogKind::program_ended, fmt::format("program '{}' stopped: {}", program_name_, reason));
  end_program(RuntimeState::stopping);
}

void ProgramRunner::log(LogKind kind, std::string text)
{
  LogEntry entry;
  entry.source = program_source;
  entry.text = std::move(text);
  entry.kind = kind;
  entry.title = program_name_;
  context_.log.add(std::move(entry));
}

bool ProgramRunner::kill()
{
  if (!program_) {
    return false;
  }
  program_->stop();
  end_program(RuntimeState::stopped);
  return true;
}

void ProgramRunner::shut_down()
{
  stop("the controller switches off");
  secondary_programs_.clear();
  compiling_.clear();
  popup_.reset();
}

void ProgramRunner::end_program(RuntimeState next)
{
  program_.reset();
  popup_.reset();
  request_.reset();
  context_.watchdog.clear();
  context_.state.runtime_state = next;
  context_.arm.end_program();
  context_.arm.resume();
}

bool ProgramRunner::paused() const
{
  const RuntimeState now = context_.state.runtime_state;
  return now == RuntimeState::paused || now == RuntimeState::pausing;
}

bool ProgramRunner::pause()
{
  if (!program_) {
    return false;
  }
  if (!paused()) {
    context_.state.runtime_state = RuntimeState::pausing;
    context_.arm.pause();
  }
  return true;
}

bool ProgramRunner::resume()
{
  if (!program_ || !paused()) {
    return false;
  }
  context_.state.runtime_state = RuntimeState::resuming;
  context_.arm.resume();
  return true;
}

void ProgramRunner::cycle()
{
  start_compiled();
  update_runtime_state();
  if (program_ && !paused()) {
    run_program();
  }
  run_secondary_programs();
}

void ProgramRunner::update_runtime_state()
{
  RuntimeState & runtime = context_.state.runtime_state;
  if (runtime == RuntimeState::pausing &&
      (context_.arm.at_rest() || context_.state.speed_scaling < paused_speed_scaling)) {
    runtime = RuntimeState::paused;
  } else if (runtime == RuntimeState::resuming) {
    runtime = RuntimeState::playing;
  } else if (runtime == RuntimeState::stopping && context_.arm.at_rest()) {
    runtime = RuntimeState::stopped;
  }
}

void ProgramRunner::run_program()
{
  switch (program_->cycle()) {
    case urscript::MachineStatus::running:
      return;
    case urscript::MachineStatus::finished:
      log(LogKind::program_ended, fmt::format("program '{}' ended", program_name_));
      break;
    case urscript::MachineStatus::failed:
      context_.log.add(LogLevel::error, program_source,
                       fmt::format("program '{}' failed in line {}: {}", program_name_,
                                   program_->error().line, program_->error().message),
                       program_->error().line);
      log(LogKind::program_ended, fmt::format("program '{}' ended by the error", program_name_));
      break;
  }
  end_program(RuntimeState::stopping);
}

void ProgramRunner::run_secondary_programs()
{
  std::erase_if(secondary_programs_, [this](const std::unique_ptr<urscript::Machine> & machine) {
    const urscript::MachineStatus status = machine->cycle();
    if (status == urscript::MachineStatus::failed) {
      log_secondary_error(*machine);
    }
    return status != urscript::MachineStatus::running;
  });
}

void ProgramRunner::log_secondary_error(const urscript::Machine & machine)
{
  LogEntry entry;
  entry.level = LogLevel::error;
  entry.source = program_source;
  entry.text = fmt::format("secondary program '{}' failed in line {}: {}", machine.program().name(),
                           machine.error().line, machine.error().message);
  entry.line = machine.error().line;
  entry.exception = "SECONDARY_PROGRAM_EXCEPTION_XXX" + machine.error().message;
  context_.log.add(std::move(entry));
}

void ProgramRunner::text_message(const std::string & text)
{
  context_.log.info("textmsg", text);
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
  context_.log.add(std::move(entry));
}

std::optional<std::uint64_t> ProgramRunner::show_request(const urscript::ValueRequest & request)
{
  if (request_) {
    return std::nullopt;
  }
  request_ = OpenRequest{++request_count_, request, std::nullopt};
  LogEntry entry;
  entry.source = "popup";
  entry.text = request.message;
  entry.kind = LogKind::value_request;
  entry.requested_type = requested_type(request.type);
  context_.log.add(std::move(entry));
  return request_count_;
}

std::optional<urscript::Value> ProgramRunner::take_answer(std::uint64_t number)
{
  if (!request_ || request_->number != number || !request_->answer) {
    return std::nullopt;
  }
  std::optional<urscript::Value> answer = std::move(request_->answer);
  request_.reset();
  return answer;
}

}  // namespace ur_simulator
