#include "urscript/interpreter/interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "urscript/interpreter/containers.hpp"
#include "urscript/interpreter/memory_meter.hpp"

namespace ur_simulator::urscript {

namespace {

// Elements per unit of cost. Costs bound the computing time of a cycle.
constexpr std::uint32_t container_cost = 4;

}  // namespace

Interpreter::Interpreter(const Code & code, const Library & library, const MachineOptions & options)
    : code_(&code), library_(library), options_(options), globals_(code.global_names.size())
{
}

void Interpreter::replace_code(const Code & code)
{
  code_ = &code;
  globals_.resize(code.global_names.size());
}

Thread & Interpreter::start_thread(std::uint32_t function, std::span<Value> arguments)
{
  const Function & entry = code_->functions[function];
  auto thread = std::make_unique<Thread>();
  thread->handle = next_handle_++;
  thread->next = entry.entry;
  thread->stack.reserve(64);
  thread->stack.assign(arguments.begin(), arguments.end());
  thread->stack.resize(entry.locals);
  thread->frames.push_back({function, 0, 0, nullptr});
  threads_.push_back(std::move(thread));
  return *threads_.back();
}

Thread * Interpreter::find_thread(std::int32_t handle)
{
  for (const auto & thread : threads_) {
    if (thread->handle == handle && thread->state != ThreadState::ended) {
      return thread.get();
    }
  }
  return nullptr;
}

void Interpreter::end_thread(Thread & thread)
{
  thread.end();
  if (critical_owner_ == thread.handle) {
    critical_owner_ = 0;
  }
}

void Interpreter::kill_thread(Thread & thread)
{
  end_thread(thread);
  for (const auto & other : threads_) {
    if (other->parent == thread.handle && other->state != ThreadState::ended) {
      kill_thread(*other);
    }
  }
}

void Interpreter::kill_threads_of_added_functions(std::size_t program_functions)
{
  for (const auto & thread : threads_) {
    const bool added =
        thread->started_by >= program_functions || thread->frames.front().function >= program_functions;
    if (added && thread->state != ThreadState::ended) {
      kill_thread(*thread);
    }
  }
}

void Interpreter::remove_ended()
{
  std::erase_if(threads_, [](const auto & thread) { return thread->state == ThreadState::ended; });
}

void Interpreter::fail(std::int32_t line, std::string message)
{
  if (!error_) {
    error_ = RunTimeError{line, std::move(message)};
  }
}

std::int32_t Interpreter::line_of(const Thread & thread) const
{
  return code_->lines[thread.next == 0 ? 0 : thread.next - 1];
}

const std::string & Interpreter::name_of(const Thread & thread) const
{
  return code_->functions[thread.frames.empty() ? 0 : thread.frames.front().function].name;
}

const Value * Interpreter::global(const std::string & name) const
{
  for (std::size_t i = 0; i < code_->global_names.size(); ++i) {
    if (code_->global_names[i] == name) {
      return globals_[i].is(Type::none) ? nullptr : &globals_[i];
    }
  }
  return nullptr;
}

std::size_t Interpreter::memory() const
{
  MemoryMeter meter;
  meter.add(globals_);
  for (const auto & thread : threads_) {
    meter.add(thread->stack);
  }
  return meter.bytes();
}

std::uint32_t Interpreter::run(Thread & thread, std::uint32_t share, CallContext & context)
{
  thread_ = &thread;
  context_ = &context;
  cost_ = 0;
  critical_owner_ = 0;
  const Instruction * instructions = code_->instructions.data();
  while (cost_ < share) {
    ++cost_;
    if (execute(instructions[thread.next++]) == Next::yield) {
      break;
    }
  }
  if (thread.state == ThreadState::ready && thread.critical > 0) {
    critical_owner_ = thread.handle;
  }
  return cost_;
}

Interpreter::Next Interpreter::fail_at_current_line(std::string message)
{
  fail(line_of(*thread_), std::move(message));
  return Next::yield;
}

Value Interpreter::pop()
{
  Value value = std::move(thread_->stack.back());
  thread_->stack.pop_back();
  return value;
}

Interpreter::Next Interpreter::replace_top(std::size_t count, tl::expected<Value, std::string> result)
{
  if (!result) {
    return fail_at_current_line(std::move(result.error()));
  }
  drop(count - 1);
  thread_->stack.back() = std::move(*result);
  return Next::proceed;
}

// Instructions on containers cost in proportion to the number of elements.
void Interpreter::add_cost(const Value & value)
{
  if (value.type() > Type::floating) {
    const std::size_t size = value.is(Type::string) ? value.string().size() / 16 : element_count(value);
    cost_ += static_cast<std::uint32_t>(size) / container_cost;
  }
}

void Interpreter::add_cost(std::span<const Value> values)
{
  for (const Value & value : values) {
    add_cost(value);
  }
}

Interpreter::Next Interpreter::load(const Value & value, const Instruction & instruction)
{
  if (value.is(Type::none)) {
    const bool is_local = instruction.op == Opcode::load_local;
    const auto & locals = code_->functions[thread_->frames.back().function].local_names;
    return fail_at_current_line(
        fmt::format("The variable '{}' has no value",
                    is_local ? locals[instruction.a] : code_->global_names[instruction.a]));
  }
  thread_->stack.push_back(value);
  return Next::proceed;
}

Interpreter::Next Interpreter::binary_operator(Operator op)
{
  Value & left = *(thread_->stack.end() - 2);
  const Value & right = thread_->stack.back();
  if (apply_to_scalars(op, left, right)) {
    thread_->stack.pop_back();
    return Next::proceed;
  }
  add_cost(left);
  add_cost(right);
  if (left.is(Type::matrix) && right.is(Type::matrix)) {
    cost_ += static_cast<std::uint32_t>(element_count(left) * right.matrix().columns) / container_cost;
  }
  return replace_top(2, binary(op, left, right));
}

Value & Interpreter::resolve_variable(const Instruction & instruction)
{
  Value & global = globals_[instruction.a];
  return global.is(Type::none) ? local(instruction.b) : global;
}

template <typename Make>
Interpreter::Next Interpreter::make_container(std::size_t count, Make make)
{
  add_cost(top(count));
  std::vector<Value> & stack = thread_->stack;
  stack.emplace_back();  // a place for the result, also of an empty container
  std::rotate(stack.end() - 1 - static_cast<std::ptrdiff_t>(count), stack.end() - 1, stack.end());
  return replace_top(count + 1, make(top(count)));
}

// Frequent instructions; the others are in execute_infrequent().
Interpreter::Next Interpreter::execute(const Instruction & instruction)
{
  std::vector<Value> & stack = thread_->stack;
  switch (instruction.op) {
    case Opcode::push_constant:
      stack.push_back(code_->constants[instruction.a]);
      return Next::proceed;
    case Opcode::load_global:
      return load(globals_[instruction.a], instruction);
    case Opcode::load_local:
      return load(local(instruction.a), instruction);
    case Opcode::load_global_or_local:
      return load(resolve_variable(instruction), instruction);
    case Opcode::store_global:
      globals_[instruction.a] = pop();
      return Next::proceed;
    case Opcode::store_local:
      local(instruction.a) = pop();
      return Next::proceed;
    case Opcode::store_global_or_local:
      resolve_variable(instruction) = pop();
      return Next::proceed;
    case Opcode::binary:
      return binary_operator(static_cast<Operator>(instruction.a));
    case Opcode::jump:
      thread_->next = instruction.a;
      return Next::proceed;
    case Opcode::jump_if_false:
      return jump_if_false(instruction);
    case Opcode::call:
      return call(instruction);
    case Opcode::call_builtin:
      return call_builtin(instruction);
    case Opcode::return_value:
      return return_value();
    case Opcode::index:
      return replace_top(instruction.a + 1, element(*(stack.end() - 1 - instruction.a), top(instruction.a)));
    default:
      return execute_infrequent(instruction);
  }
}

Interpreter::Next Interpreter::execute_infrequent(const Instruction & instruction)
{
  std::vector<Value> & stack = thread_->stack;
  switch (instruction.op) {
    case Opcode::push_none:
      stack.emplace_back();
      return Next::proceed;
    case Opcode::pop:
      stack.pop_back();
      return Next::proceed;
    case Opcode::make_list:
      return make_container(instruction.a, [](std::span<Value> elements) { return make_list(elements); });
    case Opcode::make_pose:
      return replace_top(6, make_pose(top(6)));
    case Opcode::make_structure: {
      const auto & names = code_->structure_types[instruction.a];
      return make_container(names.size(),
                            [&](std::span<Value> members) { return make_structure(names, members); });
    }
    case Opcode::member:
      return replace_top(1, member(stack.back(), code_->names[instruction.a]));
    case Opcode::store_lvalue:
      return store_lvalue(instruction);
    case Opcode::call_method_of_lvalue:
    case Opcode::call_method_of_value:
      return method(instruction);
    case Opcode::negate:
      return replace_top(1, negate(stack.back()));
    case Opcode::logical_not:
      return replace_top(1, to_condition(stack.back()).map([](bool value) { return Value(!value); }));
    case Opcode::to_boolean:
      return replace_top(1, to_condition(stack.back()).map([](bool value) { return Value(value); }));
    case Opcode::jump_if_true_or_pop:
      return jump_or_pop(instruction, true);
    case Opcode::jump_if_false_or_pop:
      return jump_or_pop(instruction, false);
    case Opcode::default_argument:
      thread_->next = local(instruction.b).is(Type::none) ? thread_->next : instruction.a;
      return Next::proceed;
    default:
      return execute_thread_instruction(instruction);
  }
}

Interpreter::Next Interpreter::execute_thread_instruction(const Instruction & instruction)
{
  switch (instruction.op) {
    case Opcode::run:
      return run_thread(instruction);
    case Opcode::kill:
      return kill_or_join(false);
    case Opcode::join:
      return kill_or_join(true);
    case Opcode::enter_critical:
      ++thread_->critical;
      return Next::proceed;
    case Opcode::exit_critical:
      return exit_critical_section();
    default:
      halted_ = true;
      return Next::yield;
  }
}

Interpreter::Next Interpreter::jump_if_false(const Instruction & instruction)
{
  const auto condition = to_condition(thread_->stack.back());
  if (!condition) {
    return fail_at_current_line(condition.error());
  }
  thread_->stack.pop_back();
  thread_->next = *condition ? thread_->next : instruction.a;
  return Next::proceed;
}

Interpreter::Next Interpreter::jump_or_pop(const Instruction & instruction, bool jump_value)
{
  const auto condition = to_condition(thread_->stack.back());
  if (!condition) {
    return fail_at_current_line(condition.error());
  }
  if (*condition == jump_value) {
    thread_->stack.back() = Value(jump_value);
    thread_->next = instruction.a;
  } else {
    thread_->stack.pop_back();
  }
  return Next::proceed;
}

}  // namespace ur_simulator::urscript
