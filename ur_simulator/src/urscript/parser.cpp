#include "urscript/parser.hpp"

#include "urscript/expression_parser.hpp"

namespace ur_simulator::urscript {

namespace {

class StatementParser : private ExpressionParser {
 public:
  StatementParser(std::string_view text, const CompileLimits & limits) : ExpressionParser(text, limits) {}

  std::unique_ptr<Definition> program()
  {
    auto text = std::make_unique<Definition>();
    text->kind = DefinitionKind::text;
    text->line = 1;
    text->column = 1;
    while (current().kind != TokenKind::end_of_text) {
      text->body.push_back(statement());
    }
    return unwrapped(std::move(text));
  }

 private:
  // A text that is nothing but one definition is that program; several definitions and statements are a body.
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

  Statement statement()
  {
    const Nesting nesting(*this);
    Statement result;
    result.line = current().line;
    result.column = current().column;
    count_node();
    if (current().kind == TokenKind::keyword && keyword_statement(result)) {
      return result;
    }
    simple_statement(result);
    return result;
  }

  bool keyword_statement(Statement & result)
  {
    if (current().is("def") || current().is("thread") || current().is("sec")) {
      result.kind = StatementKind::function;
      result.definition = definition();
    } else if (accept("if")) {
      if_statement(result);
    } else if (accept("while")) {
      result.kind = StatementKind::while_loop;
      result.branches.push_back(expression());
      expect(":");
      result.blocks.push_back(block());
      expect("end");
    } else if (accept("return")) {
      return_statement(result);
    } else if (accept("global")) {
      qualified(result, Qualifier::global);
    } else if (accept("local")) {
      qualified(result, Qualifier::local);
    } else {
      return plain_keyword(result);
    }
    return true;
  }

  bool plain_keyword(Statement & result)
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
      result.value = expression();
    } else if (accept("join")) {
      result.kind = StatementKind::join;
      result.value = expression();
    } else {
      if (current().is("for")) {
        fail_here("'for' is reserved, but URScript has no such statement; use while");
      }
      return false;
    }
    return true;
  }

  void simple_statement(Statement & result)
  {
    result.value = expression();
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
    result.value = expression();
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

  void qualified(Statement & result, Qualifier qualifier)
  {
    result.kind = StatementKind::assign;
    result.qualifier = qualifier;
    result.target = std::make_unique<Expression>();
    result.target->kind = ExpressionKind::variable;
    result.target->line = current().line;
    result.target->column = current().column;
    result.target->name = take_name("a variable name");
    if (accept("=")) {
      result.value = expression();
    }
  }

  void if_statement(Statement & result)
  {
    result.kind = StatementKind::if_else;
    do {
      result.branches.push_back(expression());
      expect(":");
      result.blocks.push_back(block());
    } while (accept("elif"));
    if (accept("else")) {
      expect(":");
      result.blocks.push_back(block());
    }
    expect("end");
  }

  // A value must begin on the line of its return: what follows on the next line is the next statement.
  void return_statement(Statement & result)
  {
    result.kind = StatementKind::return_value;
    if (current().line == result.line && starts_expression()) {
      result.value = expression();
    }
  }

  Block block()
  {
    Block result;
    while (!current().is("end") && !current().is("elif") && !current().is("else")) {
      if (current().kind == TokenKind::end_of_text) {
        fail_here("the text ends inside a block: an 'end' is missing");
      }
      result.push_back(statement());
    }
    return result;
  }

  std::unique_ptr<Definition> definition()
  {
    auto result = std::make_unique<Definition>();
    result->line = current().line;
    result->column = current().column;
    result->kind = current().is("thread") ? DefinitionKind::thread
                   : current().is("sec")  ? DefinitionKind::secondary
                                          : DefinitionKind::function;
    advance();
    result->name = take_name("a function name");
    expect("(");
    if (!current().is(")")) {
      do {
        FormalParameter parameter;
        parameter.name = take_name("a parameter name");
        if (accept("=")) {
          parameter.fallback = expression();
        }
        result->parameters.push_back(std::move(parameter));
      } while (accept(","));
    }
    expect(")");
    expect(":");
    result->body = block();
    expect("end");
    return result;
  }
};

}  // namespace

tl::expected<std::unique_ptr<Definition>, CompileError> parse(std::string_view text,
                                                              const CompileLimits & limits)
{
  if (text.size() > limits.text_bytes) {
    return tl::unexpected(
        CompileError{1, 1, "the program is larger than " + std::to_string(limits.text_bytes) + " bytes"});
  }
  try {
    return StatementParser(text, limits).program();
  } catch (const CompileError & error) {
    return tl::unexpected(error);
  }
}

}  // namespace ur_simulator::urscript
