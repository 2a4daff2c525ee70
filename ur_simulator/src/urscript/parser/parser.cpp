#include "urscript/parser/parser.hpp"

#include <algorithm>
#include <utility>

#include "urscript/parser/expression_parser.hpp"

namespace ur_simulator::urscript {

namespace {

class StatementParser : private ExpressionParser {
 public:
  StatementParser(std::string_view text, const CompileLimits & limits) : ExpressionParser(text, limits) {}

  std::unique_ptr<Definition> parse_program() { return unwrapped(parse_text()); }

  std::unique_ptr<Definition> parse_text()
  {
    auto text = std::make_unique<Definition>();
    text->kind = DefinitionKind::text;
    text->line = 1;
    text->column = 1;
    while (current().kind != TokenKind::end_of_text) {
      text->body.push_back(parse_statement());
    }
    return text;
  }

 private:
  // A text with a single definition is that program; several definitions and statements are the body of a
  // program.
  std::unique_ptr<Definition> unwrapped(std::unique_ptr<Definition> text)
  {
    for (const Statement & inner : text->body) {
      const bool secondary = inner.definition && inner.definition->kind == DefinitionKind::secondary;
      if (secondary && text->body.size() > 1) {
        fail(inner.line, inner.column, "a secondary program (sec) must stand alone");
      }
    }
    if (text->body.size() == 1 && text->body.front().definition &&
        text->body.front().definition->kind != DefinitionKind::thread) {
      auto only = std::move(text->body.front().definition);
      if (!only->parameters.empty()) {
        fail(only->line, only->column, "a program takes no parameters");
      }
      return only;
    }
    return text;
  }

  Statement parse_statement()
  {
    const Nesting nesting(*this);
    Statement result;
    result.line = current().line;
    result.column = current().column;
    count_node();
    if (current().kind == TokenKind::keyword && parse_keyword_statement(result)) {
      return result;
    }
    parse_simple_statement(result);
    return result;
  }

  bool parse_keyword_statement(Statement & result)
  {
    if (current().is("def") || current().is("thread") || current().is("sec")) {
      result.kind = StatementKind::function;
      result.definition = parse_definition();
    } else if (accept("if")) {
      parse_if(result);
    } else if (accept("while")) {
      result.kind = StatementKind::while_loop;
      result.branches.push_back(parse_expression());
      expect(":");
      result.blocks.push_back(parse_block());
      expect("end");
    } else if (accept("return")) {
      parse_return(result);
    } else if (accept("global")) {
      parse_declaration(result, Qualifier::global);
    } else if (accept("local")) {
      parse_declaration(result, Qualifier::local);
    } else {
      return parse_plain_keyword(result);
    }
    return true;
  }

  bool parse_plain_keyword(Statement & result)
  {
    if (accept("break")) {
      result.kind = StatementKind::break_loop;
    } else if (accept("continue")) {
      result.kind = StatementKind::continue_loop;
    } else if (accept("enter_critical")) {
      result.kind = StatementKind::enter_critical;
    } else if (accept("exit_critical")) {
      result.kind = StatementKind::exit_critical;
    } else if (accept("halt")) {
      result.kind = StatementKind::halt;
    } else if (accept("kill")) {
      result.kind = StatementKind::kill;
      result.value = parse_expression();
    } else if (accept("join")) {
      result.kind = StatementKind::join;
      result.value = parse_expression();
    } else {
      if (current().is("for")) {
        fail_here("'for' is reserved, but URScript has no such statement; use while");
      }
      return false;
    }
    return true;
  }

  void parse_simple_statement(Statement & result)
  {
    result.value = parse_expression();
    if (!current().is("=")) {
      const ExpressionKind kind = result.value->kind;
      if (kind != ExpressionKind::call && kind != ExpressionKind::run && kind != ExpressionKind::method) {
        fail(result.line, result.column, "expected a statement, found an expression without effect");
      }
      return;
    }
    result.kind = StatementKind::assign;
    result.target = std::move(result.value);
    check_target(*result.target);
    advance();
    result.value = parse_expression();
  }

  void check_target(const Expression & target)
  {
    const Expression * inner = &target;
    while (inner->kind == ExpressionKind::index || inner->kind == ExpressionKind::member) {
      inner = inner->operands.front().get();
    }
    if (inner->kind != ExpressionKind::variable) {
      fail(target.line, target.column, "only a variable, an element or a member can be assigned to");
    }
  }

  void parse_declaration(Statement & result, Qualifier qualifier)
  {
    result.kind = StatementKind::assign;
    result.qualifier = qualifier;
    result.target = std::make_unique<Expression>();
    result.target->kind = ExpressionKind::variable;
    result.target->line = current().line;
    result.target->column = current().column;
    result.target->name = expect_name("a variable name");
    if (accept("=")) {
      result.value = parse_expression();
    }
  }

  void parse_if(Statement & result)
  {
    result.kind = StatementKind::if_else;
    do {
      result.branches.push_back(parse_expression());
      expect(":");
      result.blocks.push_back(parse_block());
    } while (accept("elif"));
    if (accept("else")) {
      expect(":");
      result.blocks.push_back(parse_block());
    }
    expect("end");
  }

  // The value must begin on the line of `return`; the next line is the next statement.
  void parse_return(Statement & result)
  {
    result.kind = StatementKind::return_value;
    if (current().line == result.line && starts_expression()) {
      result.value = parse_expression();
    }
  }

  Block parse_block()
  {
    Block result;
    while (!current().is("end") && !current().is("elif") && !current().is("else")) {
      if (current().kind == TokenKind::end_of_text) {
        fail_here("the text ends inside a block: an 'end' is missing");
      }
      result.push_back(parse_statement());
    }
    return result;
  }

  std::unique_ptr<Definition> parse_definition()
  {
    auto result = std::make_unique<Definition>();
    result->line = current().line;
    result->column = current().column;
    result->kind = current().is("thread") ? DefinitionKind::thread
                   : current().is("sec")  ? DefinitionKind::secondary
                                          : DefinitionKind::function;
    advance();
    result->name = expect_name("a function name");
    expect("(");
    if (!current().is(")")) {
      do {
        FormalParameter parameter;
        parameter.name = expect_name("a parameter name");
        if (accept("=")) {
          parameter.default_value = parse_expression();
        }
        result->parameters.push_back(std::move(parameter));
      } while (accept(","));
    }
    expect(")");
    expect(":");
    result->body = parse_block();
    expect("end");
    return result;
  }
};

/// 1-based; "" beyond the end of the text.
std::string line_of(std::string_view text, std::int32_t number)
{
  for (; number > 1 && !text.empty(); --number) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  }
  return std::string(text.substr(0, text.find_first_of("\r\n")));
}

using Parse = std::unique_ptr<Definition> (StatementParser::*)();

tl::expected<std::unique_ptr<Definition>, CompileError> parse_with(Parse function, std::string_view text,
                                                                   const CompileLimits & limits)
{
  if (text.size() > limits.text_bytes) {
    return tl::unexpected(
        CompileError{1, 1, "the program is larger than " + std::to_string(limits.text_bytes) + " bytes"});
  }
  try {
    StatementParser parser(text, limits);
    return (parser.*function)();
  } catch (CompileError & error) {
    error.source_line = line_of(text, error.line);
    return tl::unexpected(std::move(error));
  }
}

}  // namespace

tl::expected<std::unique_ptr<Definition>, CompileError> parse(std::string_view text,
                                                              const CompileLimits & limits)
{
  return parse_with(&StatementParser::parse_program, text, limits);
}

tl::expected<std::unique_ptr<Definition>, CompileError> parse_statements(std::string_view text,
                                                                         const CompileLimits & limits)
{
  return parse_with(&StatementParser::parse_text, text, limits);
}

}  // namespace ur_simulator::urscript
