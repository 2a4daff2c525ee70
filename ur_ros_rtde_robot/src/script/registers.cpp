#include "script/registers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "ur_ros_rtde_robot/script/extension_registers.hpp"

namespace ur_ros_rtde::script {
namespace {

struct Kind {
  std::string_view direction;  ///< of the short form
  char type;
  const char * name;
  const char * function;
  std::vector<int> ScriptRegisters::* list;
  RegisterRange free;
};

const std::array<Kind, 4> & kinds()
{
  static const std::array<Kind, 4> all{{
      {"in", 'i', "input integer register", "read_input_integer_reg({})", &ScriptRegisters::input_int,
       free_inputs},
      {"in", 'f', "input float register", "read_input_float_reg({})", &ScriptRegisters::input_double,
       free_inputs},
      {"out", 'i', "output integer register", "write_output_integer_reg({}, ", &ScriptRegisters::output_int,
       free_int_outputs},
      {"out", 'f', "output float register", "write_output_float_reg({}, ", &ScriptRegisters::output_double,
       free_float_outputs},
  }};
  return all;
}

std::string not_free(const Kind & kind, int number)
{
  return fmt::format("{} {} is not available to extensions: use {}", kind.name, number, to_string(kind.free));
}

bool is_digit(char c)
{
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The short form at the beginning of `text`.
struct ShortForm {
  const Kind * kind = nullptr;
  int number = 0;
  std::size_t length = 0;  ///< including the bracket of an output
};

ShortForm short_form(std::string_view text)
{
  for (const Kind & kind : kinds()) {
    if (text.substr(1, kind.direction.size()) != kind.direction) {
      continue;
    }
    std::size_t at = 1 + kind.direction.size();
    int number = 0;
    const std::size_t digits = at;
    while (at < text.size() && is_digit(text[at]) && at - digits < 3) {
      number = 10 * number + (text[at++] - '0');
    }
    if (at == digits || at >= text.size() || text[at] != kind.type) {
      continue;
    }
    ++at;
    const bool call = at < text.size() && text[at] == '(';
    if (kind.direction == "out" && !call) {
      continue;
    }
    return {&kind, number, at + (kind.direction == "out" ? 1U : 0U)};
  }
  return {};
}

/// `$5.10 ` at the beginning of a line.
bool is_version_marker(std::string_view text, std::size_t at)
{
  const bool begins_line = at == 0 || text[at - 1] == '\n';
  return begins_line && at + 4 < text.size() && is_digit(text[at + 1]) && text[at + 2] == '.' &&
         is_digit(text[at + 3]);
}

}  // namespace

Result<std::string> expand_registers(const std::string & text, ScriptRegisters & used)
{
  std::string result;
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    line += text[i] == '\n' ? 1 : 0;
    if (text[i] != '$' || is_version_marker(text, i)) {
      result.push_back(text[i]);
      continue;
    }
    const ShortForm form = short_form(std::string_view(text).substr(i));
    if (form.kind == nullptr) {
      return fault(line, fmt::format("`{}` is not a register: write $in19i, $in19f, $out19i(x) or $out19f(x)",
                                     text.substr(i, std::min<std::size_t>(8, text.find('\n', i) - i))));
    }
    if (!form.kind->free.contains(form.number)) {
      return fault(line, not_free(*form.kind, form.number));
    }
    (used.*form.kind->list).push_back(form.number);
    result += fmt::format(fmt::runtime(form.kind->function), form.number);
    i += form.length - 1;
  }
  return result;
}

Result<void> check_registers(const ScriptRegisters & used)
{
  for (const Kind & kind : kinds()) {
    for (const int number : used.*kind.list) {
      if (!kind.free.contains(number)) {
        return fault(0, not_free(kind, number));
      }
    }
  }
  return {};
}

std::string common_register(const ScriptRegisters & a, const ScriptRegisters & b)
{
  for (const Kind & kind : kinds()) {
    for (const int number : a.*kind.list) {
      const auto & others = b.*kind.list;
      if (std::find(others.begin(), others.end(), number) != others.end()) {
        return fmt::format("{} {}", kind.name, number);
      }
    }
  }
  return {};
}

}  // namespace ur_ros_rtde::script
