#include <fmt/format.h>

#include "urscript/containers.hpp"
#include "urscript/interpreter.hpp"

// Instructions that call: functions, builtins, methods, threads.

namespace ur_simulator::urscript {

namespace {

constexpr std::uint32_t method_cost = 10;
constexpr std::size_t stack_limit = 100000;

}  // namespace

Interpreter::Next Interpreter::call(const Instruction & instruction)
{
  const Function & callee = code_.functions[instruction.a];
  if (thread_->frames.size() >= options_.call_depth || thread_->stack.size() > stack_limit) {
    return fail_here(
        fmt::format("more than {} calls inside each other at '{}'", options_.call_depth, callee.name));
  }
  const auto base = static_cast<std::uint32_t>(thread_->stack.size() - instruction.b);
  thread_->frames.push_back({instruction.a, base, thread_->next});
  thread_->stack.resize(base + callee.locals);
  thread_->next = callee.entry;
  return Next::go_on;
}

Interpreter::Next Interpreter::return_value()
{
  const Frame frame = thread_->frames.back();
  if (thread_->frames.size() == 1) {
    end(*thread_);
    return Next::leave;
  }
  Value result = pop();
  thread_->frames.pop_back();
  thread_->stack.resize(frame.base);
  thread_->stack.push_back(std::move(result));
  thread_->next = frame.return_to;
  return Next::go_on;
}

Interpreter::Next Interpreter::call_builtin(const Instruction & instruction)
{
  const Builtin & builtin = library_[instruction.a];
  cost_ += builtin.cost;
  const auto arguments = top(instruction.b);
  charge(arguments);
  for (std::size_t i = 0; i < builtin.required; ++i) {
    if (arguments[i].is(Type::none)) {
      return fail_here(
          fmt::format("{}: the argument '{}' has no value", builtin.name, builtin.parameters[i].name));
    }
  }
  context_->line = line_of(*thread_);
  Outcome outcome = builtin.function(*context_, arguments);
  if (auto * failure = std::get_if<Failure>(&outcome)) {
    const bool named = failure->message.starts_with(builtin.name + ":");
    return fail_here(named ? failure->message : builtin.name + ": " + failure->message);
  }
  return take(std::move(outcome), instruction.b);
}

Interpreter::Next Interpreter::take(Outcome outcome, std::size_t arguments)
{
  const bool waits = std::holds_alternative<NextCycle>(outcome) ||
                     std::holds_alternative<std::unique_ptr<Operation>>(outcome);
  if (waits && context_->secondary) {
    if (auto * operation = std::get_if<std::unique_ptr<Operation>>(&outcome)) {
      (*operation)->abandon();
    }
    return fail_here("a secondary program cannot call what takes physical time");
  }
  drop(arguments);
  if (auto * value = std::get_if<Value>(&outcome)) {
    thread_->stack.push_back(std::move(*value));
    return Next::go_on;
  }
  if (auto * next = std::get_if<NextCycle>(&outcome)) {
    thread_->state = ThreadState::next_cycle;
    thread_->pending = std::move(next->value);
  } else if (auto * operation = std::get_if<std::unique_ptr<Operation>>(&outcome)) {
    thread_->state = ThreadState::operation;
    thread_->operation = std::move(*operation);
  } else {
    halted_ = true;
  }
  return Next::leave;
}

Value & Interpreter::variable(const Path & path)
{
  const bool global = path.storage == Storage::global ||
                      (path.storage == Storage::free && !globals_[path.global_slot].is(Type::none));
  return global ? globals_[path.global_slot] : local(path.local_slot);
}

Interpreter::Next Interpreter::store_path(const Instruction & instruction)
{
  const Path & path = code_.paths[instruction.a];
  Value & target = variable(path);
  if (target.is(Type::none)) {
    return fail_here(fmt::format("The variable '{}' has no value", path.name));
  }
  charge(target);
  Value value = pop();
  const auto stored = assign(target, path, top(path.indices), std::move(value));
  if (!stored) {
    return fail_here(stored.error());
  }
  drop(path.indices);
  return Next::go_on;
}

Interpreter::Next Interpreter::method(const Instruction & instruction)
{
  cost_ += method_cost;
  const MethodCall & call = code_.methods[instruction.b];
  const auto arguments = top(call.arguments);
  charge(arguments);
  if (instruction.op == Op::method_of_value) {
    Value & object = *(thread_->stack.end() - 1 - call.arguments);
    charge(object);
    return replace(call.arguments + 1, call_method(object, call.name, arguments));
  }
  const Path & path = code_.paths[instruction.a];
  const auto indices = top(call.arguments + path.indices).first(path.indices);
  const auto object = follow(variable(path), path, indices, path.steps.size());
  if (!object) {
    return fail_here(object.error());
  }
  charge(**object);
  auto result = call_method(**object, call.name, arguments);
  if (!result) {
    return fail_here(std::move(result.error()));
  }
  drop(call.arguments + path.indices);
  thread_->stack.push_back(std::move(*result));
  return Next::go_on;
}

Interpreter::Next Interpreter::run_thread(const Instruction & instruction)
{
  if (threads_.size() >= options_.threads) {
    return fail_here(fmt::format("more than {} threads", options_.threads));
  }
  // It gets its turn after this thread waits, hence after the handle is assigned.
  const std::int32_t handle = start(instruction.a, top(instruction.b)).handle;
  drop(instruction.b);
  thread_->stack.emplace_back(handle);
  return Next::go_on;
}

Interpreter::Next Interpreter::kill_or_join(bool join)
{
  const Value handle = pop();
  if (!handle.is(Type::integer)) {
    return fail_here(fmt::format("Type error: {} takes a thread's handle, not {}", join ? "join" : "kill",
                                 urscript::name_of(handle.type())));
  }
  Thread * other = find(handle.integer());
  if (other == nullptr) {
    return Next::go_on;
  }
  if (join) {
    thread_->state = ThreadState::joining;
    thread_->awaited = other->handle;
    return Next::leave;
  }
  end(*other);
  return other == thread_ ? Next::leave : Next::go_on;
}

Interpreter::Next Interpreter::leave_critical()
{
  if (thread_->critical > 0 && --thread_->critical == 0) {
    critical_owner_ = 0;
  }
  return Next::go_on;
}

}  // namespace ur_simulator::urscript
