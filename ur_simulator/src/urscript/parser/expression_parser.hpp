#pragma once

#include <string>
#include <string_view>

#include "urscript/parser/lexer.hpp"
#include "urscript/parser/syntax.hpp"
#include "urscript/program.hpp"

namespace ur_simulator::urscript {

/// Parser of expressions. Precedence, lowest first: or and xor, and, not, comparisons, + -, * / %, unary
/// minus, calls and indices. Throws CompileError, which parse() catches.
class ExpressionParser {
 protected:
  ExpressionParser(std::string_view text, const CompileLimits & limits);

  ExpressionPtr parse_expression();
  bool starts_expression() const;

  const Token & current() const { return current_; }
  const Token & following() const { return following_; }
  void advance();
  bool accept(std::string_view text);
  void expect(std::string_view text);
  std::string expect_name(const char * what);

  [[noreturn]] void fail(std::int32_t line, std::int32_t column, std::string message) const;
  [[noreturn]] void fail_here(std::string message) const;
  void count_node();

  /// Limits the recursion depth of the parser and of everything that traverses the syntax tree.
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
  struct PrecedenceLevel;
  static const PrecedenceLevel precedence_levels[];

  ExpressionPtr make_node(ExpressionKind kind);
  ExpressionPtr parse_chain(std::size_t level);
  ExpressionPtr parse_operand(std::size_t level);
  ExpressionPtr parse_unary();
  ExpressionPtr parse_postfix();
  ExpressionPtr parse_primary();
  ExpressionPtr parse_number();
  ExpressionPtr parse_name();
  ExpressionPtr parse_run();
  ExpressionPtr parse_bracket();
  ExpressionPtr parse_index_or_pose(ExpressionPtr container);
  ExpressionPtr parse_member_access(ExpressionPtr object);
  void parse_arguments(Expression & call);
  void parse_elements(Expression & container);

  CompileLimits limits_;
  Lexer lexer_;
  Token current_;
  Token following_;
  std::size_t depth_ = 0;
  std::size_t nodes_ = 0;
};

}  // namespace ur_simulator::urscript
