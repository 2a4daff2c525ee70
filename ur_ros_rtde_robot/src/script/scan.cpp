#include "script/scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ur_ros_rtde::script {
namespace {

bool is_word_character(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
}

template <std::size_t N>
bool is_one_of(const Token & token, const std::array<std::string_view, N> & words)
{
  return token.kind == Token::Kind::word && std::find(words.begin(), words.end(), token.text) != words.end();
}

bool opens_block(const Token & token)
{
  constexpr std::array<std::string_view, 5> words{"def", "sec", "thread", "if", "while"};
  return is_one_of(token, words);
}

/// These words cannot occur inside brackets, so that an open bracket before them is not closed.
bool begins_statement(const Token & token)
{
  constexpr std::array<std::string_view, 9> words{"end",  "elif",  "else",   "return", "global",
                                                  "halt", "break", "thread", "def"};
  return is_one_of(token, words) || opens_block(token);
}

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  Result<std::vector<Token>> tokens()
  {
    std::vector<Token> all;
    while (position_ < text_.size()) {
      const char c = text_[position_];
      if (c == '\n') {
        ++line_;
        ++position_;
      } else if (c == ' ' || c == '\t' || c == '\r') {
        ++position_;
      } else if (c == '#') {
        position_ = std::min(text_.find('\n', position_), text_.size());
      } else if (static_cast<unsigned char>(c) < ' ') {
        return fault(line_, fmt::format("character code {} is not allowed in a script",
                                        static_cast<unsigned>(static_cast<unsigned char>(c))));
      } else if (auto next = token(c)) {
        all.push_back(*next);
      } else {
        return tl::unexpected(next.error());
      }
    }
    return all;
  }

 private:
  Result<Token> token(char first)
  {
    std::size_t end = position_ + 1;
    Token::Kind kind = Token::Kind::symbol;
    if (first == '"' || first == '\'') {
      end = text_.find_first_of(first == '"' ? "\"\n" : "'\n", end);
      if (end == std::string_view::npos || text_[end] == '\n') {
        return fault(line_, "a string is not closed on its line");
      }
      ++end;
      kind = Token::Kind::string;
    } else if (is_word_character(first)) {
      while (end < text_.size() && is_word_character(text_[end])) {
        ++end;
      }
      kind = Token::Kind::word;
    }
    const Token result{kind, text_.substr(position_, end - position_), position_, line_};
    position_ = end;
    return result;
  }

  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
};

class Brackets {
 public:
  Result<void> add(const Token & token)
  {
    constexpr std::string_view opening = "([{";
    constexpr std::string_view closing = ")]}";
    if (begins_statement(token) && !open_.empty()) {
      return not_closed();
    }
    if (token.kind != Token::Kind::symbol) {
      return {};
    }
    if (opening.find(token.text) != std::string_view::npos) {
      open_.push_back(token);
    } else if (const auto which = closing.find(token.text); which != std::string_view::npos) {
      if (open_.empty() || open_.back().text[0] != opening[which]) {
        return fault(token.line, fmt::format("'{}' has no opening bracket", token.text));
      }
      open_.pop_back();
    }
    return {};
  }
  Result<void> finish() const { return open_.empty() ? Result<void>() : not_closed(); }

 private:
  Result<void> not_closed() const
  {
    return fault(open_.back().line, fmt::format("'{}' is not closed", open_.back().text));
  }

  std::vector<Token> open_;
};

}  // namespace

const Block * Scan::block_from(std::size_t token) const
{
  const auto found =
      std::find_if(blocks.begin(), blocks.end(), [token](const Block & b) { return b.first == token; });
  return found == blocks.end() ? nullptr : &*found;
}

Result<Scan> scan(std::string_view text)
{
  auto tokens = Scanner(text).tokens();
  if (!tokens) {
    return tl::unexpected(tokens.error());
  }
  Scan result{std::move(*tokens), {}};
  std::vector<std::size_t> open;  // of result.blocks
  Brackets brackets;
  for (std::size_t i = 0; i < result.tokens.size(); ++i) {
    const Token & token = result.tokens[i];
    if (const auto ok = brackets.add(token); !ok) {
      return tl::unexpected(ok.error());
    }
    if (opens_block(token)) {
      open.push_back(result.blocks.size());
      result.blocks.push_back({i, i});
    } else if (token.is("end")) {
      if (open.empty()) {
        return fault(token.line, "this `end` has no block");
      }
      result.blocks[open.back()].last = i;
      open.pop_back();
    }
  }
  if (const auto ok = brackets.finish(); !ok) {
    return tl::unexpected(ok.error());
  }
  if (!open.empty()) {
    const Token & opener = result.tokens[result.blocks[open.back()].first];
    return fault(opener.line, fmt::format("the `{}` has no `end`", opener.text));
  }
  return result;
}

}  // namespace ur_ros_rtde::script
