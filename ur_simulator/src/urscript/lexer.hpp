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
  error,   ///< `text` says what is wrong
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

/// Cuts URScript into tokens. White space and line ends only separate: the grammar needs neither. Comments
/// run from `#` to the end of the line, and so do the program labels of PolyScope's own programs (`$ 12
/// "Wait"`).
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}
  Token next();

 private:
  void skip_blank();
  Token make(TokenKind kind, std::size_t length);
  Token number();
  Token word();
  Token string();
  Token symbol();
  char at(std::size_t offset) const
  {
    return position_ + offset < text_.size() ? text_[position_ + offset] : '\0';
  }

  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_start_ = 0;
  std::int32_t line_ = 1;
};

/// Reserved words; none of them can be a variable.
bool is_keyword(std::string_view word);

}  // namespace ur_simulator::urscript
