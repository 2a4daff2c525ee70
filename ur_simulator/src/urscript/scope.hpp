#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "urscript/code.hpp"
#include "urscript/syntax.hpp"

namespace ur_simulator::urscript {

/// What one definition declares, its nested definitions apart.
struct Scope {
  const Definition * definition = nullptr;
  Scope * parent = nullptr;
  std::uint32_t function = 0;  ///< index in Code::functions
  bool top = false;
  std::unordered_map<std::string, std::uint32_t> slots;  ///< of locals and parameters
  std::unordered_set<std::string> parameters;
  std::unordered_set<std::string> local;     ///< declared so
  std::unordered_set<std::string> global;    ///< declared so
  std::unordered_set<std::string> assigned;  ///< without qualifier
  std::unordered_map<std::string, std::uint32_t> functions;

  std::uint32_t slot(const std::string & name);
};

struct Variable {
  Storage storage;
  std::uint32_t global_slot = 0;
  std::uint32_t local_slot = 0;
};

/// Which name means what, by the script manual's "Scoping rules": variables of the program's first level are
/// global; elsewhere a name without qualifier is the global of that name if there is one, else local. Whether
/// there is one shows only at run time.
class Scopes {
 public:
  /// Walks the whole program first, so that order of definition does not matter. Functions are numbered as
  /// they are met.
  explicit Scopes(const Definition & program);

  const std::vector<std::string> & global_names() const { return global_names_; }
  Scope & of(const Definition & definition) { return scopes_.at(&definition); }
  std::size_t count() const { return scopes_.size(); }

  std::uint32_t global_slot(const std::string & name);
  /// Nothing when the name is neither a global of the program nor assigned in this scope.
  std::optional<Variable> find(Scope & scope, const std::string & name);
  /// The function or thread that a call in this scope means, from the inside out.
  std::optional<const Definition *> function(const Scope & scope, const std::string & name) const;

 private:
  void declare(const Definition & definition, Scope * parent);
  void walk(const Block & block, Scope & scope);
  void assignment(const Statement & statement, Scope & scope);

  std::map<const Definition *, Scope> scopes_;
  std::vector<const Definition *> definitions_;
  std::unordered_map<std::string, std::uint32_t> globals_;
  std::vector<std::string> global_names_;
};

}  // namespace ur_simulator::urscript
