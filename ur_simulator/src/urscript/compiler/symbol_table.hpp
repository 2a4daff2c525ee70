#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "urscript/compiler/code.hpp"
#include "urscript/parser/syntax.hpp"

namespace ur_simulator::urscript {

/// Names declared in one definition, without its nested definitions.
struct Scope {
  const Definition * definition = nullptr;
  Scope * parent = nullptr;
  std::uint32_t function = 0;  ///< index in Code::functions
  bool top = false;
  bool extension = false;                                ///< belongs to statements that extend the program
  std::unordered_map<std::string, std::uint32_t> slots;  ///< of locals and parameters
  std::unordered_set<std::string> parameters;
  std::unordered_set<std::string> local;     ///< declared with this qualifier
  std::unordered_set<std::string> global;    ///< declared with this qualifier
  std::unordered_set<std::string> assigned;  ///< assigned without qualifier
  std::unordered_map<std::string, std::uint32_t> functions;

  std::uint32_t slot(const std::string & name);
};

struct Variable {
  Storage storage;
  std::uint32_t global_slot = 0;
  std::uint32_t local_slot = 0;
};

/// Resolves names by the script manual's "Scoping rules". Variables of the first level of the program are
/// global. Elsewhere a name without qualifier refers to the global of that name if it has a value at run
/// time, else to a local.
class SymbolTable {
 public:
  /// Collects the declarations of the whole program, so that the order of definitions does not matter.
  /// Functions are numbered in order of appearance.
  explicit SymbolTable(const Definition & program);
  /// Declares statements that extend the program at its first level. Only they see their new variables.
  /// Throws CompileError if they replace a function of the program or declare a new variable with the
  /// qualifier `global`.
  Scope & extend(const Definition & statements);
  /// Lets later statements see the functions of these, or forgets these and what they declared.
  void accept_extension(const Scope & statements);
  void reject_extension(std::size_t definitions, std::size_t globals);

  const std::vector<std::string> & global_names() const { return global_names_; }
  Scope & scope_of(const Definition & definition) { return symbols_.at(&definition); }
  std::size_t count() const { return symbols_.size(); }

  /// The slot of a variable that this scope declares with the qualifier `global`.
  std::uint32_t global_slot(const Scope & scope, const std::string & name) const;
  /// Nothing if the name is neither a global of the program nor assigned in this scope.
  std::optional<Variable> find(Scope & scope, const std::string & name);
  /// The function or thread that a call in this scope refers to; inner scopes take precedence.
  std::optional<const Definition *> function(const Scope & scope, const std::string & name) const;

 private:
  Scope & add_scope(const Definition & definition, Scope * parent);
  void declare(const Definition & definition, Scope * parent);
  void visit_block(const Block & block, Scope & scope);
  void visit_assignment(const Statement & statement, Scope & scope);
  void declare_global(const Scope & scope, const std::string & name);
  std::optional<std::uint32_t> find_global(const Scope & scope, const std::string & name) const;
  void check_extension(const Statement & statement) const;

  std::map<const Definition *, Scope> symbols_;
  std::vector<const Definition *> definitions_;
  std::size_t program_definitions_;  ///< without extensions
  std::unordered_map<std::string, std::uint32_t> globals_;
  std::unordered_map<std::string, std::uint32_t> extension_variables_;  ///< the program does not see them
  std::vector<std::string> global_names_;
};

}  // namespace ur_simulator::urscript
