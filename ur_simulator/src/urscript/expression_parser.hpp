#pragma once

#include <string>
#include <string_view>

#include "urscript/lexer.hpp"
#include "urscript/program.hpp"
#include "urscript/syntax.hpp"

namespace ur_simulator::urscript {

/// The token window and the expressions of the grammar, lowest precedence first: or/xor, and, not,
/// comparisons, + -, * / %, unary minus, calls and indices. Throws CompileError; parse() catches it.
class ExpressionParser {
 protected:
  ExpressionParser(std::string_view text, const CompileLimits & limits);

  ExpressionPtr expression();
  bool starts_expression() const;

  const Token & current() const { return current_; }
  const Token & following() const { return following_; }
  void advance();
  bool accept(std::string_view text);
  void expect(std::string_view text);
  std::string take_name(const char * what);

  [[noreturn]] void fail(std::int32_t line, std::int32_t column, std::string message) const;
  [[noreturn]] void fail_here(std::string message) const;
  void count_node();

  /// Bounds recursion: of the parser, and of everything that later walks the tree.
  class Nesting {
   public:
    explicit Nesting(ExpressionParser & parser);
    ~Nesting() { --parser_.depth_; }
    Nesting(const Nesting &) = delete;
    Nesting & operator=(const Nesting &) = delete;

   private:
    ExpressionParser & parser_;
  };

 private:
  struct Level;
  static const Level levels[];

  ExpressionPtr node(ExpressionKind kind);
  ExpressionPtr chain(std::size_t level);
  ExpressionPtr operand(std::size_t level);
  ExpressionPtr unary();
  ExpressionPtr postfix();
  ExpressionPtr primary();
  ExpressionPtr number();
  ExpressionPtr name();
  ExpressionPtr run();
  ExpressionPtr bracket();
  ExpressionPtr index_or_pose(ExpressionPtr container);
  ExpressionPtr dot(ExpressionPtr object);
  void arguments(Expression & call);
  void elements(Expression & container);

  CompileLimits limits_;
  Lexer lexer_;
  Token current_;
  Token following_;
  std::size_t depth_ = 0;
  std::size_t nodes_ = 0;
};

}  // namespace ur_simulator::urscript
