#include "script_api/interpreter_mode.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/trim.hpp"

namespace ur_simulator {

namespace {

constexpr std::size_t max_queued_bytes = 4U << 20U;
/// Of statements in a control cycle, and what each adds to its text.
constexpr std::size_t max_cycle_bytes = 4000;
constexpr std::size_t statement_bytes = 100;

std::string discarded(std::string_view reason, std::string_view statement)
{
  return fmt::format("discard: {}: {}\n", reason, statement);
}

}  // namespace

void InterpreterMode::receive(std::string_view line, Reply reply)
{
  const std::string_view text = trim(line, " \t\r");
  if (text.empty()) {
    return;
  }
  if (auto answer = handle_command(text)) {
    reply(std::move(*answer));
  } else if (!program_running_) {
    reply(discarded("no program is running", text));
  } else if (queued_bytes_ + text.size() + statement_bytes > max_queued_bytes) {
    reply(discarded("too many statements are queued", text));
  } else {
    queued_bytes_ += text.size() + statement_bytes;
    queue_.push_back({std::string(text), std::move(reply)});
    interpret_queue();
  }
}

std::optional<std::string> InterpreterMode::handle_command(std::string_view line)
{
  const auto state = [line](std::size_t value) { return fmt::format("state: {}: {}\n", value, line); };
  if (line == "statelastexecuted") {
    return state(last_executed_);
  }
  if (line == "statelastinterpreted") {
    return state(last_id_);
  }
  if (line == "statelastcleared") {
    return state(last_cleared_);
  }
  if (line == "stateunexecuted") {
    return state(statements_.size() + queue_.size());
  }
  if (line != "skipbuffer" && line != "abort") {
    return std::nullopt;
  }
  if (line == "skipbuffer") {
    statements_.clear();
    clearing_ = false;
    discard_queue("skipped");
  } else if (abort_) {
    abort_();
  }
  return fmt::format("ack: {}: {}\n", last_id_, line);
}

void InterpreterMode::accept_statement(const Line & line)
{
  const auto function = extension_->add(line.text);
  if (!function) {
    line.reply(discarded(function.error(), line.text));
    return;
  }
  statements_.push_back({++last_id_, *function});
  clearing_ = line.text.find("clear_interpreter") != std::string::npos;
  line.reply(fmt::format("ack: {}: {}\n", last_id_, line.text));
}

void InterpreterMode::begin_cycle()
{
  cycle_bytes_ = 0;
  interpret_queue();
}

void InterpreterMode::interpret_queue()
{
  while (active() && may_interpret_ && !queue_.empty() && !clearing_ && cycle_bytes_ < max_cycle_bytes) {
    const Line line = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= line.text.size() + statement_bytes;
    cycle_bytes_ += line.text.size() + statement_bytes;
    accept_statement(line);
  }
}

void InterpreterMode::discard_queue(std::string_view reason)
{
  queued_bytes_ = 0;
  for (const Line & line : std::exchange(queue_, {})) {
    line.reply(discarded(reason, line.text));
  }
}

void InterpreterMode::begin(std::uint64_t program, urscript::ProgramExtension & extension,
                            const Options & options)
{
  if (program != std::exchange(program_, program)) {
    last_id_ = last_executed_ = last_cleared_ = 0;
  }
  extension_ = &extension;
  options_ = options;
  may_interpret_ = false;
  end_requested_ = false;
  clear_requested_ = false;
  clearing_ = false;
  statements_.clear();
  if (options_.clear_queue_on_enter) {
    discard_queue("cleared when interpreter mode was entered");
  }
}

bool InterpreterMode::cycle()
{
  may_interpret_ = true;
  if (std::exchange(clear_requested_, false)) {
    clear();
  }
  if (end_requested_) {
    statements_.clear();
    if (options_.clear_on_end) {
      clear();
    }
    extension_ = nullptr;
    return false;
  }
  interpret_queue();
  return true;
}

std::optional<std::uint32_t> InterpreterMode::next_function()
{
  if (statements_.empty()) {
    return std::nullopt;
  }
  const Statement next = statements_.front();
  statements_.pop_front();
  last_executed_ = next.id;
  return next.function;
}

void InterpreterMode::clear()
{
  extension_->remove_all();
  clearing_ = false;
  last_cleared_ = last_id_;
}

void InterpreterMode::cancel()
{
  extension_ = nullptr;
  statements_.clear();
}

void InterpreterMode::set_program_running(bool running)
{
  if (std::exchange(program_running_, running) && !running) {
    discard_queue("the program has ended");
  }
}

}  // namespace ur_simulator
