#include <fmt/format.h>

#include "urscript/interpreter/containers.hpp"
#include "urscript/interpreter/interpreter.hpp"

// Instructions that call functions, builtins, methods and threads.

namespace ur_simulator::urscript {

namespace {

constexpr std::uint32_t method_cost = 10;
constexpr std::size_t stack_limit = 100000;
constexpr double quick_call_limit = 0.5;  // s, of a network call in a secondary program

/// A network call of a secondary program. A robot waits within one control cycle.
class QuickCall final : public PendingCall {
 public:
  explicit QuickCall(std::unique_ptr<PendingCall> call) : call_(std::move(call)) {}

  tl::expected<std::optional<Value>, std::string> poll(CallContext & context) override
  {
    auto result = call_->poll(context);
    waited_ += context.cycle_time;
    if (!result || *result || waited_ < quick_call_limit) {
      return result;
    }
    call_->cancel();
    return tl::unexpected(fmt::format(
        "Runtime is too much behind: the other machine did not answer within {} s", quick_call_limit));
  }
  void cancel() override { call_->cancel(); }

 private:
  std::unique_ptr<PendingCall> call_;
  double waited_ = 0.0;
};

/// Limits the time that a secondary program waits. False if it would wait for something else than the
/// network.
bool limit_wait(Outcome & outcome)
{
  auto * operation = std::get_if<std::unique_ptr<PendingCall>>(&outcome);
  if (operation == nullptr) {
    return !std::holds_alternative<NextCycle>(outcome);
  }
  if (!(*operation)->is_network_call()) {
    (*operation)->cancel();
    return false;
  }
  *operation = std::make_unique<QuickCall>(std::move(*operation));
  return true;
}

}  // namespace

Interpreter::Next Interpreter::call(const Instruction & instruction)
{
  const Function & callee = code_->functions[instruction.a];
  if (thread_->frames.size() >= options_.call_depth || thread_->stack.size() > stack_limit) {
    return fail_at_current_line(
        fmt::format("call depth exceeds {} at '{}'", options_.call_depth, callee.name));
  }
  const auto base = static_cast<std::uint32_t>(thread_->stack.size() - instruction.b);
  thread_->frames.push_back({instruction.a, base, thread_->next, nullptr});
  thread_->stack.resize(base + callee.locals);
  thread_->next = callee.entry;
  return Next::proceed;
}

void Interpreter::call_from_operation(Thread & thread, std::uint32_t function)
{
  const Function & callee = code_->functions[function];
  const auto base = static_cast<std::uint32_t>(thread.stack.size());
  thread.frames.push_back({function, base, thread.next, std::move(thread.operation)});
  thread.stack.resize(base + callee.locals);
  thread.next = callee.entry;
  thread.state = ThreadState::ready;
  thread.cycles_without_wait = 0;
}

Frame Interpreter::pop_frame()
{
  Frame frame = std::move(thread_->frames.back());
  thread_->frames.pop_back();
  thread_->stack.resize(frame.base);
  thread_->next = frame.return_to;
  return frame;
}

Interpreter::Next Interpreter::return_to_operation()
{
  thread_->operation = pop_frame().caller;
  thread_->state = ThreadState::operation;
  return Next::yield;
}

Interpreter::Next Interpreter::return_value()
{
  if (thread_->frames.back().caller) {
    return return_to_operation();
  }
  if (thread_->frames.size() == 1) {
    end_thread(*thread_);
    return Next::yield;
  }
  Value result = pop();
  pop_frame();
  thread_->stack.push_back(std::move(result));
  return Next::proceed;
}

Interpreter::Next Interpreter::call_builtin(const Instruction & instruction)
{
  const Builtin & builtin = library_[instruction.a];
  cost_ += builtin.cost;
  const auto arguments = top(instruction.b);
  add_cost(arguments);
  for (std::size_t i = 0; i < builtin.required; ++i) {
    if (arguments[i].is(Type::none)) {
      return fail_at_current_line(
          fmt::format("{}: the argument '{}' has no value", builtin.name, builtin.parameters[i].name));
    }
  }
  context_->line = line_of(*thread_);
  return handle_outcome(builtin.name, builtin.function(*context_, arguments), instruction.b);
}

Interpreter::Next Interpreter::handle_outcome(const std::string & name, Outcome outcome,
                                              std::size_t arguments)
{
  if (auto * failure = std::get_if<Failure>(&outcome)) {
    const bool named = failure->message.starts_with(name + ":");
    return fail_at_current_line(named ? failure->message : name + ": " + failure->message);
  }
  if (context_->secondary && !limit_wait(outcome)) {
    return fail_at_current_line("a secondary program cannot call functions that take physical time");
  }
  drop(arguments);
  if (auto * value = std::get_if<Value>(&outcome)) {
    add_cost(*value);
    thread_->stack.push_back(std::move(*value));
    return Next::proceed;
  }
  if (auto * next = std::get_if<NextCycle>(&outcome)) {
    thread_->state = ThreadState::next_cycle;
    thread_->pending = std::move(next->value);
  } else if (auto * operation = std::get_if<std::unique_ptr<PendingCall>>(&outcome)) {
    thread_->state = ThreadState::operation;
    thread_->operation = std::move(*operation);
  } else {
    halted_ = true;
  }
  return Next::yield;
}

Value & Interpreter::variable(const Lvalue & lvalue)
{
  const bool global = lvalue.storage == Storage::global || (lvalue.storage == Storage::global_or_local &&
                                                            !globals_[lvalue.global_slot].is(Type::none));
  return global ? globals_[lvalue.global_slot] : local(lvalue.local_slot);
}

Interpreter::Next Interpreter::store_lvalue(const Instruction & instruction)
{
  const Lvalue & lvalue = code_->lvalues[instruction.a];
  Value & target = variable(lvalue);
  if (target.is(Type::none)) {
    return fail_at_current_line(fmt::format("The variable '{}' has no value", lvalue.name));
  }
  add_cost(target);
  Value value = pop();
  const auto stored = assign(target, lvalue, top(lvalue.indices), std::move(value));
  if (!stored) {
    return fail_at_current_line(stored.error());
  }
  drop(lvalue.indices);
  return Next::proceed;
}

Interpreter::Next Interpreter::method(const Instruction & instruction)
{
  cost_ += method_cost;
  const MethodCall & call = code_->methods[instruction.b];
  const auto arguments = top(call.arguments);
  add_cost(arguments);
  if (instruction.op == Opcode::call_method_of_value) {
    Value & object = *(thread_->stack.end() - 1 - call.arguments);
    add_cost(object);
    if (object.is(Type::remote)) {
      return handle_outcome(call.name, object.remote().call(call.name, arguments), call.arguments + 1);
    }
    return replace_top(call.arguments + 1, call_method(object, call.name, arguments));
  }
  const Lvalue & lvalue = code_->lvalues[instruction.a];
  const auto indices = top(call.arguments + lvalue.indices).first(lvalue.indices);
  const auto object = follow(variable(lvalue), lvalue, indices, lvalue.steps.size());
  if (!object) {
    return fail_at_current_line(object.error());
  }
  add_cost(**object);
  if ((*object)->is(Type::remote)) {
    return handle_outcome(call.name, (*object)->remote().call(call.name, arguments),
                          call.arguments + lvalue.indices);
  }
  auto result = call_method(**object, call.name, arguments);
  if (!result) {
    return fail_at_current_line(std::move(result.error()));
  }
  drop(call.arguments + lvalue.indices);
  thread_->stack.push_back(std::move(*result));
  return Next::proceed;
}

Interpreter::Next Interpreter::run_thread(const Instruction & instruction)
{
  if (threads_.size() >= options_.threads) {
    return fail_at_current_line(fmt::format("the number of threads exceeds {}", options_.threads));
  }
  // The new thread first runs after this one waits, hence after the handle is assigned.
  Thread & child = start_thread(instruction.a, top(instruction.b));
  child.parent = thread_->handle;
  child.started_by = thread_->frames.back().function;
  drop(instruction.b);
  thread_->stack.emplace_back(child.handle);
  return Next::proceed;
}

Interpreter::Next Interpreter::kill_or_join(bool join)
{
  const Value handle = pop();
  if (!handle.is(Type::integer)) {
    return fail_at_current_line(fmt::format("Type error: {} takes a thread's handle, not {}",
                                            join ? "join" : "kill", urscript::name_of(handle.type())));
  }
  Thread * other = find_thread(handle.integer());
  if (other == nullptr) {
    return Next::proceed;
  }
  if (join) {
    thread_->state = ThreadState::joining;
    thread_->joined_thread = other->handle;
    return Next::yield;
  }
  kill_thread(*other);
  return thread_->state == ThreadState::ended ? Next::yield : Next::proceed;
}

Interpreter::Next Interpreter::exit_critical_section()
{
  if (thread_->critical > 0) {
    --thread_->critical;
  }
  return Next::proceed;
}

}  // namespace ur_simulator::urscript
