#include "urscript/parser/lexer.hpp"

#include <algorithm>
#include <array>

namespace ur_simulator::urscript {

namespace {

bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}
bool is_word_start(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_word(char c)
{
  return is_word_start(c) || is_digit(c);
}

}  // namespace

bool is_keyword(std::string_view word)
{
  static constexpr std::array<std::string_view, 26> keywords{"False",
                                                             "True",
                                                             "and",
                                                             "break",
                                                             "continue",
                                                             "def",
                                                             "elif",
                                                             "else",
                                                             "end",
                                                             "enter_critical",
                                                             "exit_critical",
                                                             "for",
                                                             "global",
                                                             "halt",
                                                             "if",
                                                             "join",
                                                             "kill",
                                                             "local",
                                                             "not",
                                                             "or",
                                                             "return",
                                                             "run",
                                                             "sec",
                                                             "thread",
                                                             "while",
                                                             "xor"};
  return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

void Lexer::skip_whitespace_and_comments()
{
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '\n') {
      ++position_;
      ++line_;
      line_start_ = position_;
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v' || c == '\0') {
      ++position_;
    } else if (c == '#' || c == '$') {
      position_ = std::min(text_.find('\n', position_), text_.size());
    } else {
      return;
    }
  }
}

Token Lexer::make(TokenKind kind, std::size_t length)
{
  Token token{kind, text_.substr(position_, length), line_,
              static_cast<std::int32_t>(position_ - line_start_ + 1)};
  position_ += length;
  return token;
}

Token Lexer::next()
{
  skip_whitespace_and_comments();
  if (position_ >= text_.size()) {
    return make(TokenKind::end_of_text, 0);
  }
  const char c = text_[position_];
  if (is_digit(c) || (c == '.' && is_digit(at(1)))) {
    return read_number();
  }
  if (is_word_start(c)) {
    return read_word();
  }
  if (c == '"' || c == '\'') {
    return read_string();
  }
  return read_symbol();
}

Token Lexer::read_number()
{
  std::size_t length = 0;
  auto digits = [&] {
    while (is_digit(at(length))) {
      ++length;
    }
  };
  TokenKind kind = TokenKind::integer;
  digits();
  if (at(length) == '.') {
    kind = TokenKind::floating;
    ++length;
    digits();
  }
  if (at(length) == 'e' || at(length) == 'E') {
    const std::size_t sign = at(length + 1) == '+' || at(length + 1) == '-' ? 1 : 0;
    if (is_digit(at(length + 1 + sign))) {
      kind = TokenKind::floating;
      length += 1 + sign;
      digits();
    }
  }
  return make(kind, length);
}

Token Lexer::read_word()
{
  std::size_t length = 1;
  while (is_word(at(length))) {
    ++length;
  }
  return make(is_keyword(text_.substr(position_, length)) ? TokenKind::keyword : TokenKind::name, length);
}

Token Lexer::read_string()
{
  const char quote = text_[position_];
  std::size_t length = 1;
  while (position_ + length < text_.size() && at(length) != quote && at(length) != '\n') {
    ++length;
  }
  if (at(length) != quote) {
    Token token = make(TokenKind::error, length);
    token.text = "the string is not closed on its line";
    return token;
  }
  Token token = make(TokenKind::string, length + 1);
  token.text = token.text.substr(1, length - 1);
  return token;
}

Token Lexer::read_symbol()
{
  const char c = text_[position_];
  const bool comparison = c == '=' || c == '!' || c == '<' || c == '>';
  if (comparison && at(1) == '=') {
    return make(TokenKind::symbol, 2);
  }
  if (std::string_view("()[],:.=<>+-*/%").find(c) != std::string_view::npos) {
    return make(TokenKind::symbol, 1);
  }
  if (c == '!') {  // the script manual, "Remote Procedure Call", writes it for `not`
    Token token = make(TokenKind::keyword, 1);
    token.text = "not";
    return token;
  }
  Token token = make(TokenKind::error, 1);
  token.text = "unexpected character";
  return token;
}

}  // namespace ur_simulator::urscript
