#include "urscript/interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "urscript/containers.hpp"

namespace ur_simulator::urscript {

namespace {

// Weights keep a cycle's work within its time whatever the program does.
constexpr std::uint32_t container_cost = 4;

}  // namespace

Interpreter::Interpreter(const Code & code, const Library & library, const MachineOptions & options)
    : code_(code), library_(library), options_(options), globals_(code.global_names.size())
{
}

Thread & Interpreter::start(std::uint32_t function, std::span<Value> arguments)
{
  const Function & entry = code_.functions[function];
  auto thread = std::make_unique<Thread>();
  thread->handle = next_handle_++;
  thread->next = entry.entry;
  thread->stack.reserve(64);
  thread->stack.assign(arguments.begin(), arguments.end());
  thread->stack.resize(entry.locals);
  thread->frames.push_back({function, 0, 0});
  threads_.push_back(std::move(thread));
  return *threads_.back();
}

Thread * Interpreter::find(std::int32_t handle)
{
  for (const auto & thread : threads_) {
    if (thread->handle == handle && thread->state != ThreadState::ended) {
      return thread.get();
    }
  }
  return nullptr;
}

void Interpreter::end(Thread & thread)
{
  thread.abandon();
  if (critical_owner_ == thread.handle) {
    critical_owner_ = 0;
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
  return code_.lines[thread.next == 0 ? 0 : thread.next - 1];
}

const std::string & Interpreter::name_of(const Thread & thread) const
{
  return code_.functions[thread.frames.empty() ? 0 : thread.frames.front().function].name;
}

const Value * Interpreter::global(const std::string & name) const
{
  for (std::size_t i = 0; i < code_.global_names.size(); ++i) {
    if (code_.global_names[i] == name) {
      return globals_[i].is(Type::none) ? nullptr : &globals_[i];
    }
  }
  return nullptr;
}

std::uint32_t Interpreter::run(Thread & thread, std::uint32_t share, CallContext & context)
{
  thread_ = &thread;
  context_ = &context;
  cost_ = 0;
  const Instruction * instructions = code_.instructions.data();
  while (cost_ < share) {
    ++cost_;
    if (execute(instructions[thread.next++]) == Next::leave) {
      break;
    }
  }
  return cost_;
}

Interpreter::Next Interpreter::fail_here(std::string message)
{
  fail(line_of(*thread_), std::move(message));
  return Next::leave;
}

Value Interpreter::pop()
{
  Value value = std::move(thread_->stack.back());
  thread_->stack.pop_back();
  return value;
}

Interpreter::Next Interpreter::replace(std::size_t count, tl::expected<Value, std::string> result)
{
  if (!result) {
    return fail_here(std::move(result.error()));
  }
  drop(count - 1);
  thread_->stack.back() = std::move(*result);
  return Next::go_on;
}

// Instructions on containers take time in proportion to what these hold.
void Interpreter::charge(const Value & value)
{
  if (value.type() > Type::floating) {
    const std::size_t size = value.is(Type::string) ? value.string().size() / 16 : weight(value);
    cost_ += static_cast<std::uint32_t>(size) / container_cost;
  }
}

void Interpreter::charge(std::span<const Value> values)
{
  for (const Value & value : values) {
    charge(value);
  }
}

Interpreter::Next Interpreter::load(const Value & value, const Instruction & instruction)
{
  if (value.is(Type::none)) {
    const bool is_local = instruction.op == Op::load_local;
    const auto & locals = code_.functions[thread_->frames.back().function].local_names;
    return fail_here(fmt::format("The variable '{}' has no value",
                                 is_local ? locals[instruction.a] : code_.global_names[instruction.a]));
  }
  thread_->stack.push_back(value);
  return Next::go_on;
}

Interpreter::Next Interpreter::binary_operator(Operator op)
{
  Value & left = *(thread_->stack.end() - 2);
  const Value & right = thread_->stack.back();
  if (combine_scalars(op, left, right)) {
    thread_->stack.pop_back();
    return Next::go_on;
  }
  charge(left);
  charge(right);
  if (left.is(Type::matrix) && right.is(Type::matrix)) {
    cost_ += static_cast<std::uint32_t>(weight(left) * right.matrix().columns) / container_cost;
  }
  return replace(2, binary(op, left, right));
}

// What runs most; the rest is in execute_rare.
Interpreter::Next Interpreter::execute(const Instruction & instruction)
{
  std::vector<Value> & stack = thread_->stack;
  switch (instruction.op) {
    case Op::push_constant:
      stack.push_back(code_.constants[instruction.a]);
      return Next::go_on;
    case Op::load_global:
      return load(globals_[instruction.a], instruction);
    case Op::load_local:
      return load(local(instruction.a), instruction);
    case Op::load_free: {
      const Value & global = globals_[instruction.a];
      return load(global.is(Type::none) ? local(instruction.b) : global, instruction);
    }
    case Op::store_global:
      globals_[instruction.a] = pop();
      return Next::go_on;
    case Op::store_local:
      local(instruction.a) = pop();
      return Next::go_on;
    case Op::store_free: {
      Value & global = globals_[instruction.a];
      (global.is(Type::none) ? local(instruction.b) : global) = pop();
      return Next::go_on;
    }
    case Op::binary:
      return binary_operator(static_cast<Operator>(instruction.a));
    case Op::jump:
      thread_->next = instruction.a;
      return Next::go_on;
    case Op::jump_if_false: {
      const auto condition = truth(stack.back());
      if (!condition) {
        return fail_here(condition.error());
      }
      stack.pop_back();
      thread_->next = *condition ? thread_->next : instruction.a;
      return Next::go_on;
    }
    case Op::call:
      return call(instruction);
    case Op::call_builtin:
      return call_builtin(instruction);
    case Op::return_value:
      return return_value();
    case Op::index:
      return replace(instruction.a + 1, element(*(stack.end() - 1 - instruction.a), top(instruction.a)));
    default:
      return execute_rare(instruction);
  }
}

Interpreter::Next Interpreter::execute_rare(const Instruction & instruction)
{
  std::vector<Value> & stack = thread_->stack;
  switch (instruction.op) {
    case Op::push_none:
      stack.emplace_back();
      return Next::go_on;
    case Op::pop:
      stack.pop_back();
      return Next::go_on;
    case Op::make_list: {
      charge(top(instruction.a));
      stack.emplace_back();  // so that an empty list has a place too
      std::rotate(stack.end() - 1 - instruction.a, stack.end() - 1, stack.end());
      return replace(instruction.a + 1, make_list(top(instruction.a)));
    }
    case Op::make_pose:
      return replace(6, make_pose(top(6)));
    case Op::make_structure: {
      const auto & shape = code_.shapes[instruction.a];
      charge(top(shape.size()));
      stack.emplace_back();
      std::rotate(stack.end() - 1 - static_cast<std::ptrdiff_t>(shape.size()), stack.end() - 1, stack.end());
      return replace(shape.size() + 1, make_structure(shape, top(shape.size())));
    }
    case Op::member:
      return replace(1, member(stack.back(), code_.names[instruction.a]));
    case Op::store_path:
      return store_path(instruction);
    case Op::method_of_path:
    case Op::method_of_value:
      return method(instruction);
    case Op::negate:
      return replace(1, negate(stack.back()));
    case Op::logical_not:
      return replace(1, truth(stack.back()).map([](bool value) { return Value(!value); }));
    case Op::to_boolean:
      return replace(1, truth(stack.back()).map([](bool value) { return Value(value); }));
    case Op::jump_if_true_keep:
      return jump_keep(instruction, true);
    case Op::jump_if_false_keep:
      return jump_keep(instruction, false);
    case Op::default_argument:
      thread_->next = local(instruction.b).is(Type::none) ? thread_->next : instruction.a;
      return Next::go_on;
    case Op::run:
      return run_thread(instruction);
    case Op::kill:
      return kill_or_join(false);
    case Op::join:
      return kill_or_join(true);
    case Op::enter_critical:
      ++thread_->critical;
      critical_owner_ = thread_->handle;
      return Next::go_on;
    case Op::exit_critical:
      return leave_critical();
    default:
      halted_ = true;
      return Next::leave;
  }
}

Interpreter::Next Interpreter::jump_keep(const Instruction & instruction, bool leaves_when)
{
  const auto condition = truth(thread_->stack.back());
  if (!condition) {
    return fail_here(condition.error());
  }
  if (*condition == leaves_when) {
    thread_->stack.back() = Value(leaves_when);
    thread_->next = instruction.a;
  } else {
    thread_->stack.pop_back();
  }
  return Next::go_on;
}

}  // namespace ur_simulator::urscript
