#include "script/program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "script/scan.hpp"

namespace ur_ros_rtde::script {
namespace {

constexpr std::size_t longest_script = 1U << 20U;

std::string message(const std::string & mark)
{
  return fmt::format("  textmsg(\"{}\")", mark);
}

bool is_function(const Token & token)
{
  return token.is("def") || token.is("sec") || token.is("thread");
}

/// Index of the token `:` after the head of the function that begins at `first`.
Result<std::size_t> end_of_head(const Scan & scan, std::size_t first)
{
  for (std::size_t i = first + 2; i < scan.tokens.size(); ++i) {
    if (scan.tokens[i].is(":") && scan.tokens[i - 1].is(")")) {
      return i;
    }
  }
  const Token & head = scan.tokens[first];
  return fault(head.line, fmt::format("a program begins with `{} name():`", head.text));
}

/// Copies tokens [first, last) with the text between them and inserts the end mark before each exit.
class BodyCopy {
 public:
  BodyCopy(std::string_view script, const Scan & scan, const std::string & end_mark, ScriptText & text)
      : script_(script), scan_(scan), end_mark_(end_mark), text_(text)
  {
  }

  void copy(std::size_t first, std::size_t last)
  {
    std::size_t functions_end = first;  // token after the current nested function
    for (std::size_t i = first; i < last; ++i) {
      const Token & token = scan_.tokens[i];
      if (is_function(token) && i >= functions_end) {
        functions_end = scan_.block_from(i)->last;
      }
      if (token.is("halt") || (token.is("return") && i >= functions_end)) {
        copy_up_to(token);
        text_.insert(message(end_mark_));
      }
    }
    if (last < scan_.tokens.size()) {
      copy_up_to(scan_.tokens[last]);
    } else {
      text_.copy(script_.substr(offset_), line_);
    }
  }

  /// Continues copying at `offset`.
  void go_to(std::size_t offset, int line)
  {
    offset_ = offset;
    line_ = line;
  }

 private:
  void copy_up_to(const Token & token)
  {
    text_.copy(script_.substr(offset_, token.offset - offset_), line_);
    go_to(token.offset, token.line);
  }

  std::string_view script_;
  const Scan & scan_;
  const std::string & end_mark_;
  ScriptText & text_;
  std::size_t offset_ = 0;
  int line_ = 1;
};

void insert_beginning(ScriptText & text, const ProgramOptions & options)
{
  text.insert(message(options.begin_mark));
  if (!options.preamble.empty()) {
    text.insert(options.preamble);
  }
}

Result<Program> mark_whole(std::string_view script, const Scan & scan, const ProgramOptions & options)
{
  const Token & kind = scan.tokens.front();
  if (kind.is("sec") != options.secondary) {
    return fault(kind.line,
                 options.secondary
                     ? "a secondary program begins with `sec`, not with `def`"
                     : "a `sec` program runs beside the control program: send it as a secondary program");
  }
  const auto head = end_of_head(scan, 0);
  if (!head) {
    return tl::unexpected(head.error());
  }
  Program program;
  program.name = scan.tokens[1].text;
  const std::size_t body = scan.tokens[*head].offset + 1;
  program.text.copy(script.substr(0, body), 1);
  insert_beginning(program.text, options);
  BodyCopy copy(script, scan, options.end_mark, program.text);
  copy.go_to(body, scan.tokens[*head].line);
  copy.copy(*head + 1, scan.tokens.size() - 1);
  program.text.insert(message(options.end_mark));
  program.text.copy("end\n", scan.tokens.back().line);
  return program;
}

Result<void> check_body(const Scan & scan)
{
  std::size_t statement = 0;
  while (statement < scan.tokens.size() && is_function(scan.tokens[statement])) {
    statement = scan.block_from(statement)->last + 1;
  }
  if (statement == scan.tokens.size()) {
    return fault(0, "the script defines functions and calls none: add the call, or send one program");
  }
  return {};
}

Result<Program> wrap_body(std::string_view script, const Scan & scan, const ProgramOptions & options)
{
  if (const auto ok = check_body(scan); !ok) {
    return tl::unexpected(ok.error());
  }
  Program program;
  program.name = "ur_ros_rtde_script";
  program.text.insert(fmt::format("{} {}():", options.secondary ? "sec" : "def", program.name));
  insert_beginning(program.text, options);
  BodyCopy(script, scan, options.end_mark, program.text).copy(0, scan.tokens.size());
  program.text.insert(message(options.end_mark));
  program.text.insert("end");
  return program;
}

}  // namespace

Result<Program> make_program(std::string_view script, const ProgramOptions & options)
{
  if (script.size() > longest_script) {
    return fault(0, fmt::format("the script has {} bytes: the maximum is {}", script.size(), longest_script));
  }
  const auto scanned = scan(script);
  if (!scanned) {
    return tl::unexpected(scanned.error());
  }
  if (scanned->tokens.empty()) {
    return fault(0, "the script is empty");
  }
  const Token & first = scanned->tokens.front();
  const bool whole =
      (first.is("def") || first.is("sec")) && scanned->block_from(0)->last + 1 == scanned->tokens.size();
  return whole ? mark_whole(script, *scanned, options) : wrap_body(script, *scanned, options);
}

}  // namespace ur_ros_rtde::script
