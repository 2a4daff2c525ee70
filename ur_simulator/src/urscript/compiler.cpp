#include "urscript/expression_compiler.hpp"
#include "urscript/parser.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

namespace {

class Compiler : private ExpressionCompiler {
 public:
  Compiler(Code & code, Scopes & scopes, const Library & library, const CompileLimits & limits)
      : ExpressionCompiler(code, scopes, library, limits)
  {
  }

  void program(const Definition & definition)
  {
    code().functions.resize(scopes().count());
    function(definition);
    code().global_names = scopes().global_names();
  }

 private:
  struct Loop {
    std::uint32_t start;
    std::vector<std::uint32_t> breaks;
  };

  void function(const Definition & definition)
  {
    Scope & inner = scopes().of(definition);
    enter(inner);
    const std::uint32_t entry = emitter().here();
    for (const FormalParameter & parameter : definition.parameters) {
      if (parameter.fallback) {
        const std::uint32_t given = emitter().emit(Op::default_argument, 0, inner.slot(parameter.name));
        expression(*parameter.fallback);
        emitter().emit(Op::store_local, inner.slot(parameter.name));
        emitter().land(given);
      }
    }
    block(definition.body);
    emitter().emit(Op::push_none);
    emitter().emit(Op::return_value);
    describe(definition, inner, entry);
    nested(definition.body);
  }

  void describe(const Definition & definition, const Scope & inner, std::uint32_t entry)
  {
    Function & result = code().functions[inner.function];
    result.name = definition.name;
    result.entry = entry;
    result.parameters = static_cast<std::uint32_t>(definition.parameters.size());
    result.locals = static_cast<std::uint32_t>(inner.slots.size());
    result.local_names.resize(result.locals);
    for (const auto & [name, slot] : inner.slots) {
      result.local_names[slot] = name;
    }
  }

  void nested(const Block & body)
  {
    for (const Statement & statement : body) {
      if (statement.kind == StatementKind::function) {
        const auto outer = std::move(loops_);
        loops_.clear();
        function(*statement.definition);
        loops_ = outer;
      }
      for (const Block & inner : statement.blocks) {
        nested(inner);
      }
    }
  }

  void block(const Block & body)
  {
    for (const Statement & statement : body) {
      emitter().at_line(statement.line);
      this->statement(statement);
    }
  }

  void statement(const Statement & statement)
  {
    switch (statement.kind) {
      case StatementKind::expression:
        expression(*statement.value);
        emitter().emit(Op::pop);
        return;
      case StatementKind::assign:
        assign(statement);
        return;
      case StatementKind::if_else:
        if_else(statement);
        return;
      case StatementKind::while_loop:
        while_loop(statement);
        return;
      case StatementKind::break_loop:
        loop(statement, "break").breaks.push_back(emitter().jump(Op::jump));
        return;
      case StatementKind::continue_loop:
        emitter().emit(Op::jump, loop(statement, "continue").start);
        return;
      case StatementKind::function:
        return;  // after the body of the function around it
      default:
        simple(statement);
        return;
    }
  }

  void simple(const Statement & statement)
  {
    if (statement.value) {
      expression(*statement.value);
      emitter().at_line(statement.line);
    }
    switch (statement.kind) {
      case StatementKind::return_value:
        if (!statement.value) {
          emitter().emit(Op::push_none);
        }
        emitter().emit(Op::return_value);
        return;
      case StatementKind::kill:
        emitter().emit(Op::kill);
        return;
      case StatementKind::join:
        emitter().emit(Op::join);
        return;
      case StatementKind::enter_critical:
        emitter().emit(Op::enter_critical);
        return;
      case StatementKind::exit_critical:
        emitter().emit(Op::exit_critical);
        return;
      default:
        emitter().emit(Op::halt);
        return;
    }
  }

  void assign(const Statement & statement)
  {
    const Expression & target = *statement.target;
    if (target.kind != ExpressionKind::variable) {
      const std::uint32_t index = path(target);
      expression(*statement.value);
      emitter().at_line(statement.line);
      emitter().emit(Op::store_path, index);
      return;
    }
    if (!statement.value) {
      return;  // `global x` and `local x` only declare
    }
    expression(*statement.value);
    emitter().at_line(statement.line);
    if (statement.qualifier == Qualifier::global) {
      emitter().emit(Op::store_global, scopes().global_slot(target.name));
    } else {
      store(variable(target));
    }
  }

  void if_else(const Statement & statement)
  {
    std::vector<std::uint32_t> ends;
    for (std::size_t i = 0; i < statement.branches.size(); ++i) {
      expression(*statement.branches[i]);
      const std::uint32_t otherwise = emitter().jump(Op::jump_if_false);
      block(statement.blocks[i]);
      if (i + 1 < statement.blocks.size()) {
        ends.push_back(emitter().jump(Op::jump));
      }
      emitter().land(otherwise);
    }
    if (statement.blocks.size() > statement.branches.size()) {
      block(statement.blocks.back());
    }
    for (const std::uint32_t end : ends) {
      emitter().land(end);
    }
  }

  void while_loop(const Statement & statement)
  {
    loops_.push_back({emitter().here(), {}});
    expression(*statement.branches.front());
    const std::uint32_t leave = emitter().jump(Op::jump_if_false);
    block(statement.blocks.front());
    emitter().emit(Op::jump, loops_.back().start);
    emitter().land(leave);
    for (const std::uint32_t jump : loops_.back().breaks) {
      emitter().land(jump);
    }
    loops_.pop_back();
  }

  Loop & loop(const Statement & statement, const char * word)
  {
    if (loops_.empty()) {
      throw CompileError{statement.line, statement.column,
                         std::string("'") + word + "' outside of a while loop"};
    }
    return loops_.back();
  }

  std::vector<Loop> loops_;
};

}  // namespace

Program::Program(std::shared_ptr<const Code> code) : code_(std::move(code)) {}

const std::string & Program::name() const
{
  return code_->name;
}

bool Program::secondary() const
{
  return code_->secondary;
}

std::string CompileError::text() const
{
  return "Compile error on line " + std::to_string(line) + ", column " + std::to_string(column) + ": " +
         message;
}

tl::expected<Program, CompileError> compile(std::string_view text, const Library & library,
                                            const CompileLimits & limits)
{
  auto definition = parse(text, limits);
  if (!definition) {
    return tl::unexpected(definition.error());
  }
  auto code = std::make_shared<Code>();
  code->name = (*definition)->name;
  code->secondary = (*definition)->kind == DefinitionKind::secondary;
  try {
    Scopes scopes(**definition);
    Compiler(*code, scopes, library, limits).program(**definition);
  } catch (const CompileError & error) {
    return tl::unexpected(error);
  }
  return Program(std::move(code));
}

}  // namespace ur_simulator::urscript
