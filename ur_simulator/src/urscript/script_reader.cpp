#include "urscript/script_reader.hpp"

#include "urscript/parser/lexer.hpp"

namespace ur_simulator::urscript {

ScriptReader::ScriptReader(std::size_t limit) : limit_(limit) {}

void ScriptReader::feed(std::string_view bytes)
{
  if (ignore_input_) {
    return;
  }
  // Returned programs are erased here, all at once: erasing them one by one would move the rest of the buffer
  // each time.
  buffer_.erase(0, begin_);
  scanned_ -= begin_;
  begin_ = 0;
  buffer_ += bytes;
}

std::size_t ScriptReader::pending() const
{
  return buffer_.size() - begin_;
}

void ScriptReader::reset()
{
  buffer_.clear();
  begin_ = 0;
  scanned_ = 0;
  depth_ = 0;
  dropping_ = false;
  ignore_input_ = false;
}

// Counts the blocks that a line opens and closes; true if the program ends with the line.
bool ScriptReader::scan_line(std::string_view line)
{
  Lexer lexer(line);
  bool any = false;
  for (Token token = lexer.next(); token.kind != TokenKind::end_of_text; token = lexer.next()) {
    any = true;
    if (token.is("def") || token.is("thread") || token.is("sec") || token.is("if") || token.is("while")) {
      ++depth_;
    } else if (token.is("end") && depth_ > 0) {
      --depth_;
    }
  }
  return any && depth_ == 0;
}

std::optional<std::string> ScriptReader::next()
{
  while (true) {
    const std::size_t end = buffer_.find('\n', scanned_);
    if (end == std::string::npos) {
      break;
    }
    const bool complete = scan_line(std::string_view(buffer_).substr(scanned_, end - scanned_));
    scanned_ = end + 1;
    if (complete && !dropping_) {
      std::string program = buffer_.substr(begin_, scanned_ - begin_);
      begin_ = scanned_;
      return program;
    }
    dropping_ = dropping_ && !complete;
    if (depth_ == 0 || dropping_) {
      begin_ = scanned_;  // skips blank lines and comments between programs, and dropped programs
    }
  }
  enforce_limit();
  return std::nullopt;
}

void ScriptReader::enforce_limit()
{
  if (pending() <= limit_) {
    return;
  }
  dropped_ += dropping_ ? 0 : 1;
  ignore_input_ = buffer_.size() - scanned_ > limit_;
  dropping_ = true;
  begin_ = scanned_;
  if (ignore_input_) {
    buffer_.clear();
    begin_ = 0;
    scanned_ = 0;
  }
}

}  // namespace ur_simulator::urscript
