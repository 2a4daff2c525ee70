#include "urscript/compiler/symbol_table.hpp"

#include "urscript/program.hpp"

namespace ur_simulator::urscript {

std::uint32_t Scope::slot(const std::string & name)
{
  return slots.emplace(name, static_cast<std::uint32_t>(slots.size())).first->second;
}

SymbolTable::SymbolTable(const Definition & program)
{
  declare(program, nullptr);
  program_definitions_ = definitions_.size();
}

Scope & SymbolTable::extend(const Definition & statements)
{
  Scope & top = scope_of(*definitions_.front());
  for (const Statement & statement : statements.body) {
    check_extension(statement);
  }
  Scope & scope = add_scope(statements, &top);
  scope.top = true;
  scope.extension = true;
  visit_block(statements.body, scope);
  return scope;
}

void SymbolTable::accept_extension(const Scope & statements)
{
  for (const auto & [name, function] : statements.functions) {
    scope_of(*definitions_.front()).functions.insert_or_assign(name, function);
  }
}

void SymbolTable::reject_extension(std::size_t definitions, std::size_t globals)
{
  for (; definitions_.size() > definitions; definitions_.pop_back()) {
    symbols_.erase(definitions_.back());
  }
  std::erase_if(extension_variables_,
                [globals](const auto & variable) { return variable.second >= globals; });
  global_names_.resize(globals);
}

void SymbolTable::check_extension(const Statement & statement) const
{
  if (statement.definition) {
    const auto & functions = symbols_.at(definitions_.front()).functions;
    const auto same = functions.find(statement.definition->name);
    if (same != functions.end() && same->second < program_definitions_) {
      throw CompileError{statement.line, statement.column,
                         "'" + statement.definition->name + "' is already a function of the program"};
    }
  }
  if (statement.qualifier == Qualifier::global && !globals_.contains(statement.target->name)) {
    throw CompileError{
        statement.line, statement.column,
        "new global variables cannot be declared in interpreter mode: '" + statement.target->name + "'"};
  }
}

Scope & SymbolTable::add_scope(const Definition & definition, Scope * parent)
{
  Scope & scope = symbols_[&definition];
  scope.definition = &definition;
  scope.parent = parent;
  scope.function = static_cast<std::uint32_t>(definitions_.size());
  scope.top = parent == nullptr;
  scope.extension = parent != nullptr && parent->extension;
  definitions_.push_back(&definition);
  for (const FormalParameter & parameter : definition.parameters) {
    scope.parameters.insert(parameter.name);
    scope.slot(parameter.name);
  }
  return scope;
}

void SymbolTable::declare(const Definition & definition, Scope * parent)
{
  visit_block(definition.body, add_scope(definition, parent));
}

void SymbolTable::visit_block(const Block & block, Scope & scope)
{
  for (const Statement & statement : block) {
    if (statement.kind == StatementKind::function) {
      declare(*statement.definition, &scope);
      scope.functions[statement.definition->name] = scope_of(*statement.definition).function;
    } else if (statement.kind == StatementKind::assign) {
      visit_assignment(statement, scope);
    }
    for (const Block & inner : statement.blocks) {
      visit_block(inner, scope);
    }
  }
}

void SymbolTable::visit_assignment(const Statement & statement, Scope & scope)
{
  // An assignment to an element or a member declares no variable.
  if (statement.target->kind != ExpressionKind::variable) {
    return;
  }
  const std::string & name = statement.target->name;
  if (scope.top || statement.qualifier == Qualifier::global) {
    declare_global(scope, name);
    scope.global.insert(name);
  } else if (statement.qualifier == Qualifier::local) {
    scope.local.insert(name);
  } else {
    scope.assigned.insert(name);
  }
}

void SymbolTable::declare_global(const Scope & scope, const std::string & name)
{
  if (!find_global(scope, name)) {
    auto & variables = scope.extension ? extension_variables_ : globals_;
    variables.emplace(name, static_cast<std::uint32_t>(global_names_.size()));
    global_names_.push_back(name);
  }
}

std::optional<std::uint32_t> SymbolTable::find_global(const Scope & scope, const std::string & name) const
{
  if (const auto own = extension_variables_.find(name);
      scope.extension && own != extension_variables_.end()) {
    return own->second;
  }
  const auto found = globals_.find(name);
  return found == globals_.end() ? std::nullopt : std::optional(found->second);
}

std::uint32_t SymbolTable::global_slot(const Scope & scope, const std::string & name) const
{
  return find_global(scope, name).value();
}

std::optional<Variable> SymbolTable::find(Scope & scope, const std::string & name)
{
  if (scope.parameters.contains(name) || scope.local.contains(name)) {
    return Variable{Storage::local, 0, scope.slot(name)};
  }
  const auto global = find_global(scope, name);
  if (!global) {
    return scope.assigned.contains(name) ? std::optional(Variable{Storage::local, 0, scope.slot(name)})
                                         : std::nullopt;
  }
  const bool free = scope.assigned.contains(name) && !scope.global.contains(name);
  return free ? Variable{Storage::global_or_local, *global, scope.slot(name)}
              : Variable{Storage::global, *global, 0};
}

std::optional<const Definition *> SymbolTable::function(const Scope & scope, const std::string & name) const
{
  for (const Scope * level = &scope; level != nullptr; level = level->parent) {
    if (const auto found = level->functions.find(name); found != level->functions.end()) {
      return definitions_[found->second];
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator::urscript
