#include "urscript/compiler/expression_compiler.hpp"
#include "urscript/parser/parser.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

namespace {

class Compiler : private ExpressionCompiler {
 public:
  Compiler(Code & code, SymbolTable & symbols, const Library & library, const CompileLimits & limits)
      : ExpressionCompiler(code, symbols, library, limits)
  {
  }

  void compile_program(const Definition & definition)
  {
    code().functions.resize(symbols().count());
    compile_function(definition);
    code().global_names = symbols().global_names();
  }

  /// Returns the function that executes the statements.
  std::uint32_t compile_extension(const Definition & statements)
  {
    const Scope & added = symbols().extend(statements);
    code().functions.resize(symbols().count());
    compile_function(statements);
    const auto & names = symbols().global_names();
    code().global_names.insert(code().global_names.end(),
                               names.begin() + static_cast<std::ptrdiff_t>(code().global_names.size()),
                               names.end());
    symbols().accept_extension(added);
    return added.function;
  }

 private:
  struct Loop {
    std::uint32_t start;
    std::vector<std::uint32_t> breaks;
  };

  void compile_function(const Definition & definition)
  {
    Scope & inner = symbols().scope_of(definition);
    enter_scope(inner);
    const std::uint32_t entry = emitter().next_index();
    for (const FormalParameter & parameter : definition.parameters) {
      if (parameter.default_value) {
        const std::uint32_t given = emitter().emit(Opcode::default_argument, 0, inner.slot(parameter.name));
        compile_expression(*parameter.default_value);
        emitter().emit(Opcode::store_local, inner.slot(parameter.name));
        emitter().patch_jump(given);
      }
    }
    compile_block(definition.body);
    emitter().emit(Opcode::push_none);
    emitter().emit(Opcode::return_value);
    describe_function(definition, inner, entry);
    compile_nested_functions(definition.body);
  }

  void describe_function(const Definition & definition, const Scope & inner, std::uint32_t entry)
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

  void compile_nested_functions(const Block & body)
  {
    for (const Statement & statement : body) {
      if (statement.kind == StatementKind::function) {
        const auto outer = std::move(loops_);
        loops_.clear();
        compile_function(*statement.definition);
        loops_ = outer;
      }
      for (const Block & inner : statement.blocks) {
        compile_nested_functions(inner);
      }
    }
  }

  void compile_block(const Block & body)
  {
    for (const Statement & statement : body) {
      emitter().set_line(statement.line);
      this->compile_statement(statement);
    }
  }

  void compile_statement(const Statement & statement)
  {
    switch (statement.kind) {
      case StatementKind::expression:
        compile_expression(*statement.value);
        emitter().emit(Opcode::pop);
        return;
      case StatementKind::assign:
        compile_assignment(statement);
        return;
      case StatementKind::if_else:
        compile_if(statement);
        return;
      case StatementKind::while_loop:
        compile_while(statement);
        return;
      case StatementKind::break_loop:
        enclosing_loop(statement, "break").breaks.push_back(emitter().emit_jump(Opcode::jump));
        return;
      case StatementKind::continue_loop:
        emitter().emit(Opcode::jump, enclosing_loop(statement, "continue").start);
        return;
      case StatementKind::function:
        return;  // compiled after the body of the enclosing function
      default:
        compile_simple_statement(statement);
        return;
    }
  }

  void compile_simple_statement(const Statement & statement)
  {
    if (statement.value) {
      compile_expression(*statement.value);
      emitter().set_line(statement.line);
    }
    switch (statement.kind) {
      case StatementKind::return_value:
        if (!statement.value) {
          emitter().emit(Opcode::push_none);
        }
        emitter().emit(Opcode::return_value);
        return;
      case StatementKind::kill:
        emitter().emit(Opcode::kill);
        return;
      case StatementKind::join:
        emitter().emit(Opcode::join);
        return;
      case StatementKind::enter_critical:
        emitter().emit(Opcode::enter_critical);
        return;
      case StatementKind::exit_critical:
        emitter().emit(Opcode::exit_critical);
        return;
      default:
        emitter().emit(Opcode::halt);
        return;
    }
  }

  void compile_assignment(const Statement & statement)
  {
    const Expression & target = *statement.target;
    if (const IndexedName * indexed = indexed_name(target)) {
      compile_indexed_assignment(statement, *indexed);
      return;
    }
    if (target.kind != ExpressionKind::variable) {
      const std::uint32_t index = make_lvalue(target);
      compile_expression(*statement.value);
      emitter().set_line(statement.line);
      emitter().emit(Opcode::store_lvalue, index);
      return;
    }
    if (!statement.value) {
      return;  // `global x` and `local x` are declarations
    }
    compile_expression(*statement.value);
    emitter().set_line(statement.line);
    if (statement.qualifier == Qualifier::global) {
      emitter().emit(Opcode::store_global, symbols().global_slot(scope(), target.name));
    } else {
      emit_store(variable(target));
    }
  }

  // `digital_out[2] = True` calls set_digital_out(2, True).
  void compile_indexed_assignment(const Statement & statement, const IndexedName & indexed)
  {
    const Expression & target = *statement.target;
    if (!indexed.setter) {
      fail(target, "'" + target.operands.front()->name + "' can only be read");
    }
    compile_expression(*target.operands[1]);
    compile_expression(*statement.value);
    emitter().set_line(statement.line);
    emitter().emit(Opcode::call_builtin, *indexed.setter, 2);
    emitter().emit(Opcode::pop);
  }

  void compile_if(const Statement & statement)
  {
    std::vector<std::uint32_t> ends;
    for (std::size_t i = 0; i < statement.branches.size(); ++i) {
      compile_expression(*statement.branches[i]);
      const std::uint32_t otherwise = emitter().emit_jump(Opcode::jump_if_false);
      compile_block(statement.blocks[i]);
      if (i + 1 < statement.blocks.size()) {
        ends.push_back(emitter().emit_jump(Opcode::jump));
      }
      emitter().patch_jump(otherwise);
    }
    if (statement.blocks.size() > statement.branches.size()) {
      compile_block(statement.blocks.back());
    }
    for (const std::uint32_t end : ends) {
      emitter().patch_jump(end);
    }
  }

  void compile_while(const Statement & statement)
  {
    loops_.push_back({emitter().next_index(), {}});
    compile_expression(*statement.branches.front());
    const std::uint32_t leave = emitter().emit_jump(Opcode::jump_if_false);
    compile_block(statement.blocks.front());
    emitter().emit(Opcode::jump, loops_.back().start);
    emitter().patch_jump(leave);
    for (const std::uint32_t jump : loops_.back().breaks) {
      emitter().patch_jump(jump);
    }
    loops_.pop_back();
  }

  Loop & enclosing_loop(const Statement & statement, const char * word)
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

bool Program::is_secondary() const
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
  const auto definition = parse(text, limits);
  if (!definition) {
    return tl::unexpected(definition.error());
  }
  auto code = std::make_shared<Code>();
  code->name = (*definition)->name;
  code->secondary = (*definition)->kind == DefinitionKind::secondary;
  code->source = text;
  try {
    SymbolTable symbols(**definition);
    Compiler(*code, symbols, library, limits).compile_program(**definition);
  } catch (const CompileError & error) {
    return tl::unexpected(error);
  }
  return Program(std::move(code));
}

class ExtendedProgram::Impl {
 public:
  Impl(const Program & program, const Library & library, const CompileLimits & limits)
      : library_(library),
        limits_(limits),
        code_(program.code()),
        symbols_(parse_again(program.code().source))
  {
  }

  tl::expected<std::uint32_t, CompileError> add(std::string_view statements)
  {
    auto parsed = parse_statements(statements, limits_);
    if (!parsed) {
      return tl::unexpected(parsed.error());
    }
    const CodeSize before(code_);
    const std::size_t definitions = symbols_.count();
    definitions_.push_back(std::move(*parsed));
    try {
      return Compiler(code_, symbols_, library_, limits_).compile_extension(*definitions_.back());
    } catch (const CompileError & error) {
      symbols_.reject_extension(definitions, before.globals());
      before.restore(code_);
      definitions_.pop_back();
      return tl::unexpected(error);
    }
  }
  const Code & code() const { return code_; }

 private:
  /// The program has been parsed before, without an error.
  const Definition & parse_again(const std::string & source)
  {
    definitions_.push_back(std::move(parse(source, limits_).value()));
    return *definitions_.front();
  }

  /// What was added to a Code since its construction can be removed.
  class CodeSize {
   public:
    explicit CodeSize(const Code & code) : sizes_(apply(code, [](const auto & part) { return part.size(); }))
    {
    }
    void restore(Code & code) const
    {
      auto size = sizes_.begin();
      apply(code, [&size](auto & part) {
        part.resize(*size);
        return *size++;
      });
    }
    std::size_t globals() const { return sizes_.back(); }

   private:
    template <class AnyCode, class Function>
    static std::array<std::size_t, 9> apply(AnyCode & code, const Function & function)
    {
      return {function(code.instructions), function(code.lines),   function(code.constants),
              function(code.functions),    function(code.names),   function(code.structure_types),
              function(code.lvalues),      function(code.methods), function(code.global_names)};
    }

    std::array<std::size_t, 9> sizes_;
  };

  const Library & library_;
  const CompileLimits limits_;
  std::vector<std::unique_ptr<Definition>> definitions_;  ///< of the program and of all statements
  Code code_;
  SymbolTable symbols_;
};

ExtendedProgram::ExtendedProgram(const Program & program, const Library & library,
                                 const CompileLimits & limits)
    : impl_(std::make_unique<Impl>(program, library, limits))
{
}

ExtendedProgram::~ExtendedProgram() = default;

tl::expected<std::uint32_t, CompileError> ExtendedProgram::add(std::string_view statements)
{
  return impl_->add(statements);
}

const Code & ExtendedProgram::code() const
{
  return impl_->code();
}

}  // namespace ur_simulator::urscript
