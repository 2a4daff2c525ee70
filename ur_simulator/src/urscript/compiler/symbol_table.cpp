#include "urscript/compiler/symbol_table.hpp"

namespace ur_simulator::urscript {

std::uint32_t Scope::slot(const std::string & name)
{
  return slots.emplace(name, static_cast<std::uint32_t>(slots.size())).first->second;
}

SymbolTable::SymbolTable(const Definition & program)
{
  declare(program, nullptr);
}

void SymbolTable::declare(const Definition & definition, Scope * parent)
{
  Scope & scope = symbols_[&definition];
  scope.definition = &definition;
  scope.parent = parent;
  scope.function = static_cast<std::uint32_t>(definitions_.size());
  scope.top = parent == nullptr;
  definitions_.push_back(&definition);
  for (const FormalParameter & parameter : definition.parameters) {
    scope.parameters.insert(parameter.name);
    scope.slot(parameter.name);
  }
  visit_block(definition.body, scope);
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
    global_slot(name);
    scope.global.insert(name);
  } else if (statement.qualifier == Qualifier::local) {
    scope.local.insert(name);
  } else {
    scope.assigned.insert(name);
  }
}

std::uint32_t SymbolTable::global_slot(const std::string & name)
{
  const auto [entry, new_index] = globals_.emplace(name, static_cast<std::uint32_t>(global_names_.size()));
  if (new_index) {
    global_names_.push_back(name);
  }
  return entry->second;
}

std::optional<Variable> SymbolTable::find(Scope & scope, const std::string & name)
{
  if (scope.parameters.contains(name) || scope.local.contains(name)) {
    return Variable{Storage::local, 0, scope.slot(name)};
  }
  const auto global = globals_.find(name);
  if (global == globals_.end()) {
    return scope.assigned.contains(name) ? std::optional(Variable{Storage::local, 0, scope.slot(name)})
                                         : std::nullopt;
  }
  const bool free = scope.assigned.contains(name) && !scope.global.contains(name);
  return free ? Variable{Storage::global_or_local, global->second, scope.slot(name)}
              : Variable{Storage::global, global->second, 0};
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
