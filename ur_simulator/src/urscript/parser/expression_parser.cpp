#include "urscript/parser/expression_parser.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <limits>
#include <optional>

namespace ur_simulator::urscript {

struct ExpressionParser::PrecedenceLevel {
  struct Spelling {
    std::string_view text;
    Operator op;
  };
  Spelling spellings[6];

  std::optional<Operator> find(const Token & token) const
  {
    for (const Spelling & spelling : spellings) {
      if (!spelling.text.empty() && token.is(spelling.text)) {
        return spelling.op;
      }
    }
    return std::nullopt;
  }
};

const ExpressionParser::PrecedenceLevel ExpressionParser::precedence_levels[] = {
    {{{"or", Operator::logical_or}, {"xor", Operator::logical_xor}}},
    {{{"and", Operator::logical_and}}},
    {{{"==", Operator::equal},
      {"!=", Operator::not_equal},
      {"<", Operator::less},
      {"<=", Operator::less_equal},
      {">", Operator::greater},
      {">=", Operator::greater_equal}}},
    {{{"+", Operator::add}, {"-", Operator::subtract}}},
    {{{"*", Operator::multiply}, {"/", Operator::divide}, {"%", Operator::modulo}}},
};

namespace {

constexpr std::size_t comparison_level = 2;
constexpr std::size_t level_count = 5;

}  // namespace

ExpressionParser::Nesting::Nesting(ExpressionParser & parser) : parser_(parser)
{
  if (++parser.depth_ > parser.limits_.nesting) {
    // The destructor does not run after an exception in the constructor.
    --parser.depth_;
    parser.fail_here("nested deeper than " + std::to_string(parser.limits_.nesting) + " levels");
  }
}

ExpressionParser::ExpressionParser(std::string_view text, const CompileLimits & limits)
    : limits_(limits), lexer_(text)
{
  advance();
  advance();
}

void ExpressionParser::advance()
{
  current_ = following_;
  following_ = lexer_.next();
  if (current_.kind == TokenKind::error) {
    fail_here(std::string(current_.text));
  }
}

bool ExpressionParser::accept(std::string_view text)
{
  if (!current_.is(text)) {
    return false;
  }
  advance();
  return true;
}

void ExpressionParser::expect(std::string_view text)
{
  if (!accept(text)) {
    const std::string found = current_.kind == TokenKind::end_of_text
                                  ? "the end of the text"
                                  : fmt::format("'{}'", current_.text.substr(0, 40));
    fail_here(fmt::format("expected '{}', found {}", text, found));
  }
}

std::string ExpressionParser::expect_name(const char * what)
{
  if (current_.kind != TokenKind::name) {
    fail_here(std::string("expected ") + what + ", found '" + std::string(current_.text.substr(0, 40)) + "'");
  }
  std::string taken(current_.text);
  advance();
  return taken;
}

void ExpressionParser::fail(std::int32_t line, std::int32_t column, std::string message) const
{
  throw CompileError{line, column, std::move(message)};
}

void ExpressionParser::fail_here(std::string message) const
{
  fail(current_.line, current_.column, std::move(message));
}

void ExpressionParser::count_node()
{
  if (++nodes_ > limits_.nodes) {
    fail_here("the program is too large");
  }
}

ExpressionPtr ExpressionParser::make_node(ExpressionKind kind)
{
  count_node();
  auto result = std::make_unique<Expression>();
  result->kind = kind;
  result->line = current_.line;
  result->column = current_.column;
  return result;
}

bool ExpressionParser::starts_expression() const
{
  switch (current_.kind) {
    case TokenKind::integer:
    case TokenKind::floating:
    case TokenKind::string:
    case TokenKind::name:
      return true;
    case TokenKind::keyword:
      return current_.is("True") || current_.is("False") || current_.is("not") || current_.is("run");
    case TokenKind::symbol:
      return current_.is("(") || current_.is("[") || current_.is("-") || current_.is("+");
    default:
      return false;
  }
}

ExpressionPtr ExpressionParser::parse_expression()
{
  return parse_chain(0);
}

ExpressionPtr ExpressionParser::parse_chain(std::size_t level)
{
  auto first = parse_operand(level);
  if (!precedence_levels[level].find(current_)) {
    return first;
  }
  auto result = make_node(ExpressionKind::chain);
  result->operands.push_back(std::move(first));
  while (const auto op = precedence_levels[level].find(current_)) {
    advance();
    result->operators.push_back(*op);
    result->operands.push_back(parse_operand(level));
  }
  return result;
}

// The precedence of `not` is between `and` and the comparisons: not a == b means not (a == b).
ExpressionPtr ExpressionParser::parse_operand(std::size_t level)
{
  if (level + 1 == comparison_level && current_.is("not")) {
    const Nesting nesting(*this);
    auto result = make_node(ExpressionKind::logical_not);
    advance();
    result->operands.push_back(parse_operand(level));
    return result;
  }
  return level + 1 < level_count ? parse_chain(level + 1) : parse_unary();
}

ExpressionPtr ExpressionParser::parse_unary()
{
  const Nesting nesting(*this);
  if (accept("+")) {
    return parse_unary();
  }
  if (current_.is("-")) {
    auto result = make_node(ExpressionKind::negate);
    advance();
    result->operands.push_back(parse_unary());
    return result;
  }
  // Also accepted: x == not y
  if (current_.is("not")) {
    auto result = make_node(ExpressionKind::logical_not);
    advance();
    result->operands.push_back(parse_unary());
    return result;
  }
  return parse_postfix();
}

ExpressionPtr ExpressionParser::parse_postfix()
{
  auto result = parse_primary();
  std::size_t links = 0;
  while (current_.is("[") || current_.is(".")) {
    // Each link adds a level to the tree.
    if (++links + depth_ > limits_.nesting) {
      fail_here("nested deeper than " + std::to_string(limits_.nesting) + " levels");
    }
    result =
        current_.is("[") ? parse_index_or_pose(std::move(result)) : parse_member_access(std::move(result));
  }
  return result;
}

ExpressionPtr ExpressionParser::parse_primary()
{
  switch (current_.kind) {
    case TokenKind::integer:
    case TokenKind::floating:
      return parse_number();
    case TokenKind::string: {
      auto result = make_node(ExpressionKind::literal);
      result->value = Value(std::string(current_.text));
      advance();
      return result;
    }
    case TokenKind::name:
      return parse_name();
    default:
      break;
  }
  if (current_.is("True") || current_.is("False")) {
    auto result = make_node(ExpressionKind::literal);
    result->value = Value(current_.is("True"));
    advance();
    return result;
  }
  if (current_.is("run")) {
    return parse_run();
  }
  return parse_bracket();
}

ExpressionPtr ExpressionParser::parse_number()
{
  auto result = make_node(ExpressionKind::literal);
  const std::string digits(current_.text);
  if (current_.kind == TokenKind::integer) {
    errno = 0;
    // Base 10: a leading zero does not mean octal.
    const long long value = std::strtoll(digits.c_str(), nullptr, 10);
    const bool fits = errno == 0 && value <= std::numeric_limits<std::int32_t>::max();
    result->value =
        fits ? Value(static_cast<std::int32_t>(value)) : Value(std::strtod(digits.c_str(), nullptr));
  } else {
    result->value = Value(std::strtod(digits.c_str(), nullptr));
  }
  advance();
  return result;
}

ExpressionPtr ExpressionParser::parse_name()
{
  const bool call = following_.is("(");
  auto result = make_node(call ? ExpressionKind::call : ExpressionKind::variable);
  result->name = expect_name("a name");
  if (call) {
    parse_arguments(*result);
  }
  return result;
}

ExpressionPtr ExpressionParser::parse_run()
{
  auto result = make_node(ExpressionKind::run);
  advance();
  result->name = expect_name("the name of a thread after run");
  parse_arguments(*result);
  return result;
}

ExpressionPtr ExpressionParser::parse_bracket()
{
  const Nesting nesting(*this);
  if (accept("(")) {
    auto result = parse_expression();
    expect(")");
    return result;
  }
  if (current_.is("[")) {
    auto result = make_node(ExpressionKind::list);
    parse_elements(*result);
    return result;
  }
  if (current_.kind == TokenKind::end_of_text) {
    fail_here("expected a value, found the end of the text");
  }
  fail_here("expected a value, found '" + std::string(current_.text.substr(0, 40)) + "'");
}

// p[x, y, z, rx, ry, rz] is a pose; otherwise `p` is an ordinary variable.
ExpressionPtr ExpressionParser::parse_index_or_pose(ExpressionPtr container)
{
  const Nesting nesting(*this);
  auto result = make_node(ExpressionKind::index);
  const bool may_be_pose = container->kind == ExpressionKind::variable && container->name == "p";
  result->operands.push_back(std::move(container));
  parse_elements(*result);
  const std::size_t count = result->operands.size() - 1;
  if (may_be_pose && count == 6) {
    result->kind = ExpressionKind::pose;
    result->operands.erase(result->operands.begin());
  } else if (count != 1 && count != 2) {
    fail(result->line, result->column,
         may_be_pose ? "a pose has six elements, not " + std::to_string(count)
                     : "one index or two (row, column) are expected");
  }
  return result;
}

void ExpressionParser::parse_elements(Expression & container)
{
  expect("[");
  if (!current_.is("]")) {
    do {
      container.operands.push_back(parse_expression());
    } while (accept(","));
  }
  expect("]");
}

ExpressionPtr ExpressionParser::parse_member_access(ExpressionPtr object)
{
  auto result = make_node(ExpressionKind::member);
  advance();
  if (current_.kind == TokenKind::keyword) {  // time().sec
    current_.kind = TokenKind::name;
  }
  result->name = expect_name("the name of a member");
  result->operands.push_back(std::move(object));
  if (current_.is("(")) {
    result->kind = ExpressionKind::method;
    parse_arguments(*result);
  }
  return result;
}

void ExpressionParser::parse_arguments(Expression & call)
{
  const Nesting nesting(*this);
  expect("(");
  if (!current_.is(")")) {
    do {
      const bool named = current_.kind == TokenKind::name && following_.is("=");
      call.argument_names.push_back(named ? expect_name("a name") : std::string());
      if (named) {
        expect("=");
      }
      call.operands.push_back(parse_expression());
    } while (accept(","));
  }
  expect(")");
}

}  // namespace ur_simulator::urscript
