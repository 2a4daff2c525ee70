#include "urscript/expression_compiler.hpp"

#include <functional>

namespace ur_simulator::urscript {

namespace {

constexpr std::uint32_t missing = 0xFFFFFFFF;

/// For each parameter the operand that a call gives for it.
std::vector<std::uint32_t> match_arguments(const Expression & call, std::size_t parameters,
                                           const std::function<std::string(std::size_t)> & parameter_name,
                                           const std::function<void(std::string)> & fail)
{
  std::vector<std::uint32_t> given(parameters, missing);
  bool named = false;
  for (std::uint32_t i = 0; i < call.operands.size(); ++i) {
    const std::string & name = call.argument_names[i];
    std::size_t position = i;
    if (!name.empty()) {
      named = true;
      position = 0;
      while (position < parameters && parameter_name(position) != name) {
        ++position;
      }
      if (position == parameters) {
        fail("The function '" + call.name + "' has no parameter '" + name + "'");
      }
    } else if (named) {
      fail("In the call of '" + call.name + "' a positional argument follows a named one");
    } else if (position >= parameters) {
      fail("The function '" + call.name + "' takes " + std::to_string(parameters) + " arguments, " +
           std::to_string(call.operands.size()) + " are given");
    }
    if (given[position] != missing) {
      fail("In the call of '" + call.name + "' the argument '" + parameter_name(position) +
           "' is given twice");
    }
    given[position] = i;
  }
  return given;
}

}  // namespace

void ExpressionCompiler::fail(const Expression & where, std::string message)
{
  throw CompileError{where.line, where.column, std::move(message)};
}

void ExpressionCompiler::expression(const Expression & expression)
{
  emitter_.at_line(expression.line);
  switch (expression.kind) {
    case ExpressionKind::literal:
      emitter_.constant(expression.value);
      return;
    case ExpressionKind::variable:
      load(expression);
      return;
    case ExpressionKind::chain:
      chain(expression);
      return;
    case ExpressionKind::call:
      call(expression);
      return;
    case ExpressionKind::method:
      method(expression);
      return;
    case ExpressionKind::run:
      if (const auto thread = scopes_.function(*scope_, expression.name)) {
        call_defined(expression, **thread, Op::run);
        return;
      }
      fail(expression, "The thread '" + expression.name + "' is not defined");
    default:
      break;
  }
  for (const ExpressionPtr & operand : expression.operands) {
    this->expression(*operand);
  }
  emitter_.at_line(expression.line);
  const auto count = static_cast<std::uint32_t>(expression.operands.size());
  switch (expression.kind) {
    case ExpressionKind::list:
      emitter_.emit(Op::make_list, count);
      return;
    case ExpressionKind::pose:
      emitter_.emit(Op::make_pose);
      return;
    case ExpressionKind::index:
      emitter_.emit(Op::index, count - 1);
      return;
    case ExpressionKind::member:
      emitter_.emit(Op::member, emitter_.name(expression.name));
      return;
    case ExpressionKind::negate:
      emitter_.emit(Op::negate);
      return;
    default:
      emitter_.emit(Op::logical_not);
      return;
  }
}

Variable ExpressionCompiler::variable(const Expression & expression)
{
  if (const auto found = scopes_.find(*scope_, expression.name)) {
    return *found;
  }
  fail(expression, "The variable '" + expression.name + "' is not defined");
}

void ExpressionCompiler::load(const Expression & expression)
{
  const auto found = scopes_.find(*scope_, expression.name);
  if (!found) {
    if (const Value * constant = library_.constant(expression.name)) {
      emitter_.constant(*constant);
      return;
    }
  }
  const Variable source = variable(expression);
  switch (source.storage) {
    case Storage::global:
      emitter_.emit(Op::load_global, source.global_slot);
      return;
    case Storage::local:
      emitter_.emit(Op::load_local, source.local_slot);
      return;
    case Storage::free:
      emitter_.emit(Op::load_free, source.global_slot, source.local_slot);
      return;
  }
}

void ExpressionCompiler::store(const Variable & variable)
{
  switch (variable.storage) {
    case Storage::global:
      emitter_.emit(Op::store_global, variable.global_slot);
      return;
    case Storage::local:
      emitter_.emit(Op::store_local, variable.local_slot);
      return;
    case Storage::free:
      emitter_.emit(Op::store_free, variable.global_slot, variable.local_slot);
      return;
  }
}

void ExpressionCompiler::structure(const Expression & expression)
{
  std::vector<std::string> shape;
  for (std::size_t i = 0; i < expression.operands.size(); ++i) {
    if (expression.argument_names[i].empty()) {
      fail(expression, "every member of struct(...) needs a name: struct(name = value, ...)");
    }
    shape.push_back(expression.argument_names[i]);
    this->expression(*expression.operands[i]);
  }
  code_.shapes.push_back(std::move(shape));
  emitter_.emit(Op::make_structure, static_cast<std::uint32_t>(code_.shapes.size() - 1));
}

void ExpressionCompiler::chain(const Expression & expression)
{
  this->expression(*expression.operands.front());
  std::size_t i = 0;
  while (i < expression.operators.size()) {
    const Operator op = expression.operators[i];
    if (op != Operator::logical_or && op != Operator::logical_and) {
      this->expression(*expression.operands[i + 1]);
      emitter_.at_line(expression.operands[i + 1]->line);
      emitter_.emit(Op::binary, static_cast<std::uint32_t>(op));
      ++i;
      continue;
    }
    std::size_t last = i;
    while (last + 1 < expression.operators.size() && expression.operators[last + 1] == op) {
      ++last;
    }
    logical_run(expression, i, last);
    i = last + 1;
  }
}

// A run of equal logical operators leaves at its end as soon as the result is known.
void ExpressionCompiler::logical_run(const Expression & expression, std::size_t first, std::size_t last)
{
  const Op leave =
      expression.operators[first] == Operator::logical_or ? Op::jump_if_true_keep : Op::jump_if_false_keep;
  std::vector<std::uint32_t> jumps;
  for (std::size_t i = first; i <= last; ++i) {
    jumps.push_back(emitter_.jump(leave));
    this->expression(*expression.operands[i + 1]);
  }
  emitter_.emit(Op::to_boolean);
  for (const std::uint32_t jump : jumps) {
    emitter_.land(jump);
  }
}

void ExpressionCompiler::call(const Expression & expression)
{
  if (const auto definition = scopes_.function(*scope_, expression.name)) {
    call_defined(expression, **definition, Op::call);
  } else if (expression.name == "struct") {
    structure(expression);
  } else if (const auto builtin = library_.find(expression.name)) {
    call_builtin(expression, *builtin);
  } else {
    fail(expression, "The function '" + expression.name + "' is not defined");
  }
}

void ExpressionCompiler::call_defined(const Expression & expression, const Definition & definition, Op op)
{
  const auto & parameters = definition.parameters;
  const auto given = match_arguments(
      expression, parameters.size(), [&](std::size_t i) { return parameters[i].name; },
      [&](std::string message) { fail(expression, std::move(message)); });
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (given[i] != missing) {
      this->expression(*expression.operands[given[i]]);
    } else if (parameters[i].fallback) {
      emitter_.emit(Op::push_none);
    } else {
      fail(expression,
           "The function '" + expression.name + "' needs the argument '" + parameters[i].name + "'");
    }
  }
  emitter_.at_line(expression.line);
  emitter_.emit(op, scopes_.of(definition).function, static_cast<std::uint32_t>(parameters.size()));
}

void ExpressionCompiler::call_builtin(const Expression & expression, std::uint32_t index)
{
  const Builtin & builtin = library_[index];
  std::size_t count = builtin.parameters.size();
  if (builtin.variadic) {
    count = std::max(count, expression.operands.size());
  }
  const auto name = [&](std::size_t i) {
    return i < builtin.parameters.size() ? builtin.parameters[i].name : std::to_string(i + 1);
  };
  const auto given = match_arguments(expression, count, name,
                                     [&](std::string message) { fail(expression, std::move(message)); });
  for (std::size_t i = 0; i < count; ++i) {
    if (given[i] != missing) {
      this->expression(*expression.operands[given[i]]);
    } else if (i < builtin.required) {
      fail(expression, "The function '" + expression.name + "' needs the argument '" + name(i) + "'");
    } else if (builtin.parameters[i].fallback.is(Type::none)) {
      emitter_.emit(Op::push_none);
    } else {
      emitter_.constant(builtin.parameters[i].fallback);
    }
  }
  emitter_.at_line(expression.line);
  emitter_.emit(Op::call_builtin, index, static_cast<std::uint32_t>(count));
}

bool ExpressionCompiler::is_path(const Expression & expression) const
{
  const Expression * inner = &expression;
  while (inner->kind == ExpressionKind::index || inner->kind == ExpressionKind::member) {
    inner = inner->operands.front().get();
  }
  return inner->kind == ExpressionKind::variable && scopes_.find(*scope_, inner->name).has_value();
}

void ExpressionCompiler::collect_path(const Expression & target, Path & path)
{
  if (target.kind == ExpressionKind::variable) {
    const Variable base = variable(target);
    path.storage = base.storage;
    path.global_slot = base.global_slot;
    path.local_slot = base.local_slot;
    path.name = target.name;
    return;
  }
  collect_path(*target.operands.front(), path);
  PathStep step;
  step.member = target.name;
  for (std::size_t i = 1; i < target.operands.size(); ++i) {
    expression(*target.operands[i]);
    ++step.indices;
  }
  path.indices += step.indices;
  path.steps.push_back(std::move(step));
}

std::uint32_t ExpressionCompiler::path(const Expression & target)
{
  Path path;
  collect_path(target, path);
  code_.paths.push_back(std::move(path));
  return static_cast<std::uint32_t>(code_.paths.size() - 1);
}

void ExpressionCompiler::method(const Expression & expression)
{
  const Expression & object = *expression.operands.front();
  const bool in_place = is_path(object);
  std::uint32_t path = 0;
  if (in_place) {
    path = this->path(object);
  } else {
    this->expression(object);
  }
  for (std::size_t i = 1; i < expression.operands.size(); ++i) {
    if (!expression.argument_names[i - 1].empty()) {
      fail(expression, "the method '" + expression.name + "' takes no named arguments");
    }
    this->expression(*expression.operands[i]);
  }
  code_.methods.push_back({expression.name, static_cast<std::uint32_t>(expression.operands.size() - 1)});
  emitter_.at_line(expression.line);
  emitter_.emit(in_place ? Op::method_of_path : Op::method_of_value, path,
                static_cast<std::uint32_t>(code_.methods.size() - 1));
}

}  // namespace ur_simulator::urscript
