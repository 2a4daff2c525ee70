#include "urscript/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>

#include "urscript/interpreter/interpreter.hpp"

namespace ur_simulator::urscript {

namespace {

// Also granted to threads that run last in a cycle.
constexpr std::uint32_t min_instructions_per_turn = 200;

// The memory of a program is measured after this many instructions. In between it grows by at most 30 MB: an
// instruction costs in proportion to the elements that it creates.
constexpr std::uint32_t instructions_between_measurements = 250000;

constexpr std::int32_t main_thread = 1;  // handle

std::uint64_t next_program()
{
  static std::atomic<std::uint64_t> count{0};
  return ++count;
}

}  // namespace

struct Machine::Impl final : ProgramExtension {
  Impl(Program compiled, std::shared_ptr<const Library> functions, Host & to, const MachineOptions & settings)
      : program(std::move(compiled)),
        library(std::move(functions)),
        options(settings),
        context{to, settings.cycle_time, 0.0, 0, program.is_secondary(), next_program(), *this},
        interpreter(program.code(), *library, options)
  {
    interpreter.start_thread(0, {});
  }

  void cycle()
  {
    instructions = 0;
    context.time = options.clock ? options.clock() : static_cast<double>(cycles) * options.cycle_time;
    // A thread that has not finished the computation of a critical section continues before the others.
    const std::int32_t first = interpreter.critical_owner();
    if (Thread * thread = interpreter.find_thread(first)) {
      run_turn(*thread, interpreter.threads().size());
      check_end();
    }
    // By index: a thread may start others, which run in the same cycle.
    for (std::size_t i = 0; i < interpreter.threads().size() && status == MachineStatus::running; ++i) {
      Thread & thread = *interpreter.threads()[i];
      if (thread.handle != first && try_resume(thread)) {
        run_turn(thread, interpreter.threads().size() - i);
      }
      check_end();
    }
    interpreter.remove_ended();
    limit_memory();
    ++cycles;
  }

  // Ends the wait of the thread if possible; true if the thread may run.
  bool try_resume(Thread & thread)
  {
    if (thread.state == ThreadState::operation) {
      poll(thread);
    } else if (thread.state == ThreadState::next_cycle) {
      resume(thread, std::move(thread.pending));
    } else if (thread.state == ThreadState::joining &&
               interpreter.find_thread(thread.joined_thread) == nullptr) {
      thread.state = ThreadState::ready;
      thread.cycles_without_wait = 0;
    }
    return thread.state == ThreadState::ready && interpreter.critical_owner() == 0 && !interpreter.error();
  }

  void poll(Thread & thread)
  {
    context.line = interpreter.line_of(thread);
    auto result = thread.operation->poll(context);
    if (!result) {
      interpreter.fail(interpreter.line_of(thread), std::move(result.error()));
    } else if (*result) {
      thread.operation.reset();
      resume(thread, std::move(**result));
    } else if (const auto function = thread.operation->next_function()) {
      interpreter.call_from_operation(thread, *function);
    }
  }

  tl::expected<std::uint32_t, std::string> add(std::string_view statements) override
  {
    if (!extended) {
      extended.emplace(program, *library);
    }
    const auto function = extended->add(statements);
    if (!function) {
      return tl::unexpected(function.error().text());
    }
    interpreter.replace_code(extended->code());
    return *function;
  }

  void remove_all() override
  {
    interpreter.kill_threads_of_added_functions(program.code().functions.size());
    interpreter.replace_code(program.code());
    extended.reset();
  }

  static void resume(Thread & thread, Value value)
  {
    thread.stack.push_back(std::move(value));
    thread.pending = Value();
    thread.state = ThreadState::ready;
    thread.cycles_without_wait = 0;
  }

  void run_turn(Thread & thread, std::size_t threads_left)
  {
    const std::uint32_t left =
        options.instructions_per_cycle - std::min(instructions, options.instructions_per_cycle);
    const std::uint32_t share =
        std::max(left / static_cast<std::uint32_t>(threads_left), min_instructions_per_turn);
    context.received_data = false;
    context.main_thread = thread.handle == main_thread;
    instructions += interpreter.run(thread, share, context);
    if (context.received_data) {
      thread.cycles_without_wait = 0;
    }
    if (thread.state != ThreadState::ready) {
      return;
    }
    ++thread.cycles_without_wait;
    if (static_cast<double>(thread.cycles_without_wait) * options.cycle_time > options.infinite_loop_after) {
      interpreter.fail(
          interpreter.line_of(thread),
          fmt::format("infinite loop: '{}' has computed for {} s without taking time; use sync() or sleep()",
                      interpreter.name_of(thread), options.infinite_loop_after));
    }
  }

  void limit_memory()
  {
    instructions_since_measurement += instructions;
    if (status != MachineStatus::running ||
        instructions_since_measurement < instructions_between_measurements) {
      return;
    }
    instructions_since_measurement = 0;
    if (interpreter.memory() > options.memory) {
      interpreter.fail(interpreter.line_of(*interpreter.threads().front()),
                       fmt::format("out of memory: the values of the program need more than {} MiB",
                                   options.memory >> 20U));
      check_end();
    }
  }

  void check_end()
  {
    if (interpreter.error()) {
      finish(MachineStatus::failed);
    } else if (interpreter.halted() || interpreter.find_thread(main_thread) == nullptr) {
      finish(MachineStatus::finished);
    }
  }

  void finish(MachineStatus how)
  {
    if (status != MachineStatus::running) {
      return;
    }
    status = how;
    for (const auto & thread : interpreter.threads()) {
      interpreter.end_thread(*thread);
    }
    library->handle_end(context.program);
  }

  const Program program;
  std::optional<ExtendedProgram> extended;  ///< if statements have been added
  std::shared_ptr<const Library> library;
  MachineOptions options;
  CallContext context;
  Interpreter interpreter;
  MachineStatus status = MachineStatus::running;
  std::uint64_t cycles = 0;
  std::uint32_t instructions = 0;
  std::uint32_t instructions_since_measurement = 0;
};

Machine::Machine(Program program, std::shared_ptr<const Library> library, Host & host,
                 const MachineOptions & options)
    : impl_(std::make_unique<Impl>(std::move(program), std::move(library), host, options))
{
}

Machine::~Machine()
{
  stop();
}

MachineStatus Machine::cycle()
{
  if (impl_->status == MachineStatus::running) {
    try {
      impl_->cycle();
    } catch (const std::exception & error) {
      // Out of memory or a builtin that throws ends the program, not the controller.
      impl_->interpreter.fail(0, error.what());
      impl_->finish(MachineStatus::failed);
    }
  }
  return impl_->status;
}

void Machine::stop()
{
  impl_->finish(MachineStatus::finished);
}

MachineStatus Machine::status() const
{
  return impl_->status;
}

const RunTimeError & Machine::error() const
{
  static const RunTimeError none;
  return impl_->interpreter.error() ? *impl_->interpreter.error() : none;
}

const Program & Machine::program() const
{
  return impl_->program;
}

std::size_t Machine::thread_count() const
{
  return impl_->status == MachineStatus::running ? impl_->interpreter.threads().size() : 0;
}

std::uint32_t Machine::instructions() const
{
  return impl_->instructions;
}

const std::vector<std::string> & Machine::global_names() const
{
  return impl_->program.code().global_names;
}

const Value * Machine::global(const std::string & name) const
{
  return impl_->interpreter.global(name);
}

}  // namespace ur_simulator::urscript
