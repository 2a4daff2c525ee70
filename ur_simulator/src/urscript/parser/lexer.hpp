#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ur_simulator::urscript {

enum class TokenKind : std::uint8_t {
  end_of_text,
  integer,
  floating,
  string,
  name,
  keyword,
  symbol,  ///< ( ) [ ] , : . = == != < <= > >= + - * / %
  error,   ///< `text` is the error message
};

struct Token {
  TokenKind kind = TokenKind::end_of_text;
  std::string_view text;  ///< of a string: without its quotes
  std::int32_t line = 1;
  std::int32_t column = 1;

  bool is(std::string_view expected) const
  {
    return (kind == TokenKind::keyword || kind == TokenKind::symbol) && text == expected;
  }
};

/// Splits URScript into tokens. White space and line ends only separate tokens. Comments (`#`) and the
/// program labels of PolyScope programs (`$ 12 "Wait"`) extend to the end of the line.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}
  Token next();

 private:
  void skip_whitespace_and_comments();
  Token make(TokenKind kind, std::size_t length);
  Token read_number();
  Token read_word();
  Token read_string();
  Token read_symbol();
  char at(std::size_t offset) const
  {
    return position_ + offset < text_.size() ? text_[position_ + offset] : '\0';
  }

  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_start_ = 0;
  std::int32_t line_ = 1;
};

/// True for reserved words, which cannot be names of variables.
bool is_keyword(std::string_view word);

}  // namespace ur_simulator::urscript
