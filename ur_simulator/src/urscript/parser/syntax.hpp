#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// Operators. In the syntax tree, operators of one precedence level form one flat node, so that the depth of
/// the tree is the nesting depth of the text.
enum class Operator : std::uint8_t {
  logical_or,
  logical_xor,
  logical_and,
  equal,
  not_equal,
  less,
  less_equal,
  greater,
  greater_equal,
  add,
  subtract,
  multiply,
  divide,
  modulo,
};

enum class ExpressionKind : std::uint8_t {
  literal,      ///< value
  variable,     ///< name
  list,         ///< operands
  pose,         ///< six operands
  index,        ///< operands: the container, then one or two indices
  member,       ///< name; operands: the structure
  call,         ///< name; operands: arguments; argument_names: their names, "" if positional
  method,       ///< as call; operands[0] is the object
  run,          ///< as call, of a thread
  negate,       ///< operands[0]
  logical_not,  ///< operands[0]
  chain,        ///< operands[0] operators[0] operands[1] operators[1] …, left to right
};

struct Expression {
  ExpressionKind kind = ExpressionKind::literal;
  std::int32_t line = 0;
  std::int32_t column = 0;
  std::string name;
  Value value;
  std::vector<std::unique_ptr<Expression>> operands;
  std::vector<Operator> operators;
  std::vector<std::string> argument_names;
};

using ExpressionPtr = std::unique_ptr<Expression>;

enum class StatementKind : std::uint8_t {
  expression,  ///< value: a call or run
  assign,      ///< target, value
  if_else,     ///< branches; blocks has one more element if there is an else
  while_loop,  ///< branches[0], blocks[0]
  break_loop,
  continue_loop,
  return_value,  ///< value or null
  kill,          ///< value
  join,          ///< value
  enter_critical,
  exit_critical,
  halt,
  function,  ///< definition
};

enum class Qualifier : std::uint8_t { none, global, local };

struct Definition;
struct Statement;
using Block = std::vector<Statement>;

struct Statement {
  StatementKind kind = StatementKind::expression;
  Qualifier qualifier = Qualifier::none;
  std::int32_t line = 0;
  std::int32_t column = 0;
  ExpressionPtr target;
  ExpressionPtr value;
  std::vector<ExpressionPtr> branches;
  std::vector<Block> blocks;
  std::unique_ptr<Definition> definition;
};

enum class DefinitionKind : std::uint8_t { function, thread, secondary, text };

struct FormalParameter {
  std::string name;
  ExpressionPtr default_value;  ///< null: the argument is required
};

struct Definition {
  DefinitionKind kind = DefinitionKind::function;
  std::string name;
  std::int32_t line = 0;
  std::int32_t column = 0;
  std::vector<FormalParameter> parameters;
  Block body;
};

}  // namespace ur_simulator::urscript
