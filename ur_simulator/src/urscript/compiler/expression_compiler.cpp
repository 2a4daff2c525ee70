#include "urscript/compiler/expression_compiler.hpp"

#include <fmt/format.h>

#include "urscript/compiler/argument_matching.hpp"

namespace ur_simulator::urscript {

void ExpressionCompiler::fail(const Expression & where, std::string message)
{
  throw CompileError{where.line, where.column, std::move(message)};
}

void ExpressionCompiler::fail_undefined(const Expression & where, std::string_view kind)
{
  throw CompileError{where.line, where.column, fmt::format("The {} '{}' is not defined", kind, where.name),
                     where.name};
}

void ExpressionCompiler::compile_expression(const Expression & expression)
{
  emitter_.set_line(expression.line);
  switch (expression.kind) {
    case ExpressionKind::literal:
      emitter_.emit_constant(expression.value);
      return;
    case ExpressionKind::variable:
      emit_load(expression);
      return;
    case ExpressionKind::chain:
      compile_chain(expression);
      return;
    case ExpressionKind::call:
      compile_call(expression);
      return;
    case ExpressionKind::method:
      compile_method_call(expression);
      return;
    case ExpressionKind::run:
      if (const auto thread = symbols_.function(*scope_, expression.name)) {
        compile_function_call(expression, **thread, Opcode::run);
        return;
      }
      fail_undefined(expression, "thread");
    default:
      compile_operation(expression);
      return;
  }
}

const IndexedName * ExpressionCompiler::indexed_name(const Expression & expression) const
{
  if (expression.kind != ExpressionKind::index || expression.operands.size() != 2 ||
      expression.operands.front()->kind != ExpressionKind::variable) {
    return nullptr;
  }
  const std::string & name = expression.operands.front()->name;
  return symbols_.find(*scope_, name) ? nullptr : library_.indexed_name(name);
}

void ExpressionCompiler::compile_operation(const Expression & expression)
{
  if (const IndexedName * indexed = indexed_name(expression)) {
    compile_expression(*expression.operands[1]);
    emitter_.emit(Opcode::call_builtin, indexed->getter, 1);
    return;
  }
  for (const ExpressionPtr & operand : expression.operands) {
    compile_expression(*operand);
  }
  emitter_.set_line(expression.line);
  const auto count = static_cast<std::uint32_t>(expression.operands.size());
  switch (expression.kind) {
    case ExpressionKind::list:
      emitter_.emit(Opcode::make_list, count);
      return;
    case ExpressionKind::pose:
      emitter_.emit(Opcode::make_pose);
      return;
    case ExpressionKind::index:
      emitter_.emit(Opcode::index, count - 1);
      return;
    case ExpressionKind::member:
      emitter_.emit(Opcode::member, emitter_.name_index(expression.name));
      return;
    case ExpressionKind::negate:
      emitter_.emit(Opcode::negate);
      return;
    default:
      emitter_.emit(Opcode::logical_not);
      return;
  }
}

Variable ExpressionCompiler::variable(const Expression & expression)
{
  if (const auto found = symbols_.find(*scope_, expression.name)) {
    return *found;
  }
  fail_undefined(expression, "variable");
}

void ExpressionCompiler::emit_load(const Expression & expression)
{
  const auto found = symbols_.find(*scope_, expression.name);
  if (!found) {
    if (const Value * constant = library_.constant(expression.name)) {
      emitter_.emit_constant(*constant);
      return;
    }
  }
  const Variable source = variable(expression);
  switch (source.storage) {
    case Storage::global:
      emitter_.emit(Opcode::load_global, source.global_slot);
      return;
    case Storage::local:
      emitter_.emit(Opcode::load_local, source.local_slot);
      return;
    case Storage::global_or_local:
      emitter_.emit(Opcode::load_global_or_local, source.global_slot, source.local_slot);
      return;
  }
}

void ExpressionCompiler::emit_store(const Variable & variable)
{
  switch (variable.storage) {
    case Storage::global:
      emitter_.emit(Opcode::store_global, variable.global_slot);
      return;
    case Storage::local:
      emitter_.emit(Opcode::store_local, variable.local_slot);
      return;
    case Storage::global_or_local:
      emitter_.emit(Opcode::store_global_or_local, variable.global_slot, variable.local_slot);
      return;
  }
}

void ExpressionCompiler::compile_structure(const Expression & expression)
{
  std::vector<std::string> member_names;
  for (std::size_t i = 0; i < expression.operands.size(); ++i) {
    if (expression.argument_names[i].empty()) {
      fail(expression, "every member of struct(...) needs a name: struct(name = value, ...)");
    }
    member_names.push_back(expression.argument_names[i]);
    compile_expression(*expression.operands[i]);
  }
  code_.structure_types.push_back(std::move(member_names));
  emitter_.emit(Opcode::make_structure, static_cast<std::uint32_t>(code_.structure_types.size() - 1));
}

void ExpressionCompiler::compile_chain(const Expression & expression)
{
  compile_expression(*expression.operands.front());
  std::size_t i = 0;
  while (i < expression.operators.size()) {
    const Operator op = expression.operators[i];
    if (op != Operator::logical_or && op != Operator::logical_and) {
      compile_expression(*expression.operands[i + 1]);
      emitter_.set_line(expression.operands[i + 1]->line);
      emitter_.emit(Opcode::binary, static_cast<std::uint32_t>(op));
      ++i;
      continue;
    }
    std::size_t last = i;
    while (last + 1 < expression.operators.size() && expression.operators[last + 1] == op) {
      ++last;
    }
    compile_short_circuit(expression, i, last);
    i = last + 1;
  }
}

// Jumps behind a run of equal logical operators as soon as the result is known.
void ExpressionCompiler::compile_short_circuit(const Expression & expression, std::size_t first,
                                               std::size_t last)
{
  const Opcode leave = expression.operators[first] == Operator::logical_or ? Opcode::jump_if_true_or_pop
                                                                           : Opcode::jump_if_false_or_pop;
  std::vector<std::uint32_t> jumps;
  for (std::size_t i = first; i <= last; ++i) {
    jumps.push_back(emitter_.emit_jump(leave));
    compile_expression(*expression.operands[i + 1]);
  }
  emitter_.emit(Opcode::to_boolean);
  for (const std::uint32_t jump : jumps) {
    emitter_.patch_jump(jump);
  }
}

void ExpressionCompiler::compile_call(const Expression & expression)
{
  if (const auto definition = symbols_.function(*scope_, expression.name)) {
    compile_function_call(expression, **definition, Opcode::call);
  } else if (expression.name == "struct") {
    compile_structure(expression);
  } else if (const auto builtin = library_.find(expression.name)) {
    compile_builtin_call(expression, *builtin);
  } else {
    fail_undefined(expression, "function");
  }
}

void ExpressionCompiler::compile_function_call(const Expression & expression, const Definition & definition,
                                               Opcode op)
{
  const auto & parameters = definition.parameters;
  const auto given = match_arguments(
      expression, parameters.size(), [&](std::size_t i) { return parameters[i].name; },
      [&](std::size_t i, const std::string & argument) { return parameters[i].name == argument; },
      [&](std::string message) { fail(expression, std::move(message)); });
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (given[i] != no_argument) {
      compile_expression(*expression.operands[given[i]]);
    } else if (parameters[i].default_value) {
      emitter_.emit(Opcode::push_none);
    } else {
      fail(expression,
           "The function '" + expression.name + "' needs the argument '" + parameters[i].name + "'");
    }
  }
  emitter_.set_line(expression.line);
  emitter_.emit(op, symbols_.scope_of(definition).function, static_cast<std::uint32_t>(parameters.size()));
}

void ExpressionCompiler::compile_builtin_call(const Expression & expression, std::uint32_t index)
{
  const Builtin & builtin = library_[index];
  std::size_t count = builtin.parameters.size();
  if (builtin.variadic) {
    count = std::max(count, expression.operands.size());
  }
  const auto name = [&](std::size_t i) {
    return i < builtin.parameters.size() ? builtin.parameters[i].name : std::to_string(i + 1);
  };
  const auto is_called = [&](std::size_t i, const std::string & argument) {
    return i < builtin.parameters.size() ? builtin.parameters[i].is_called(argument) : name(i) == argument;
  };
  const auto given = match_arguments(expression, count, name, is_called,
                                     [&](std::string message) { fail(expression, std::move(message)); });
  for (std::size_t i = 0; i < count; ++i) {
    if (given[i] != no_argument) {
      compile_expression(*expression.operands[given[i]]);
    } else if (i < builtin.required) {
      fail(expression, "The function '" + expression.name + "' needs the argument '" + name(i) + "'");
    } else if (builtin.parameters[i].default_value.is(Type::none)) {
      emitter_.emit(Opcode::push_none);
    } else {
      emitter_.emit_constant(builtin.parameters[i].default_value);
    }
  }
  emitter_.set_line(expression.line);
  emitter_.emit(Opcode::call_builtin, index, static_cast<std::uint32_t>(count));
}

bool ExpressionCompiler::is_lvalue(const Expression & expression) const
{
  const Expression * inner = &expression;
  while (inner->kind == ExpressionKind::index || inner->kind == ExpressionKind::member) {
    inner = inner->operands.front().get();
  }
  return inner->kind == ExpressionKind::variable && symbols_.find(*scope_, inner->name).has_value();
}

void ExpressionCompiler::collect_lvalue(const Expression & target, Lvalue & lvalue)
{
  if (target.kind == ExpressionKind::variable) {
    const Variable base = variable(target);
    lvalue.storage = base.storage;
    lvalue.global_slot = base.global_slot;
    lvalue.local_slot = base.local_slot;
    lvalue.name = target.name;
    return;
  }
  collect_lvalue(*target.operands.front(), lvalue);
  LvalueStep step;
  step.member = target.name;
  for (std::size_t i = 1; i < target.operands.size(); ++i) {
    compile_expression(*target.operands[i]);
    ++step.indices;
  }
  lvalue.indices += step.indices;
  lvalue.steps.push_back(std::move(step));
}

std::uint32_t ExpressionCompiler::make_lvalue(const Expression & target)
{
  Lvalue lvalue;
  collect_lvalue(target, lvalue);
  code_.lvalues.push_back(std::move(lvalue));
  return static_cast<std::uint32_t>(code_.lvalues.size() - 1);
}

void ExpressionCompiler::compile_method_call(const Expression & expression)
{
  const Expression & object = *expression.operands.front();
  const bool in_place = is_lvalue(object);
  std::uint32_t lvalue = 0;
  if (in_place) {
    lvalue = make_lvalue(object);
  } else {
    compile_expression(object);
  }
  for (std::size_t i = 1; i < expression.operands.size(); ++i) {
    if (!expression.argument_names[i - 1].empty()) {
      fail(expression, "the method '" + expression.name + "' takes no named arguments");
    }
    compile_expression(*expression.operands[i]);
  }
  code_.methods.push_back({expression.name, static_cast<std::uint32_t>(expression.operands.size() - 1)});
  emitter_.set_line(expression.line);
  emitter_.emit(in_place ? Opcode::call_method_of_lvalue : Opcode::call_method_of_value, lvalue,
                static_cast<std::uint32_t>(code_.methods.size() - 1));
}

}  // namespace ur_simulator::urscript
