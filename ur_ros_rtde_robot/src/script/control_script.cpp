#include "script/control_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "script/registers.hpp"
#include "script/scan.hpp"

namespace ur_ros_rtde::script {
namespace {

constexpr int first_id = 256;
constexpr std::string_view before_commands = "    def process_cmd(cmd):\n";
constexpr std::string_view before_loop = "            cmd = rtde_cmd()\n";

/// Runs an extension in a thread when input float register 18 contains its number. Output float register 18
/// is minus the number while the extension runs, the number when it has finished, and 0 when the script is
/// ready for the next one. If the number is cleared before the extension has finished, 0 also means that the
/// arm has stopped. A number that is in the register when the script begins is ignored until it is cleared.
/// After an extension that has finished, there is no stopj: a command may move the arm, and two threads that
/// do end the program.
constexpr std::string_view dispatcher = R"(
    global extension_id = 0
    global extension_state = 5 # 0 none, 1 under way, 2 done, 3 being stopped, 4 stopped, 5 before the first
    global extension_thrd = 0

    thread extension_thread():
{choice}{mode_ends}        extension_state = 2
    end

    # the modes first: freedrive ignores stopj
    thread extension_stop_thread():
{mode_ends}        stopj(4)
        extension_state = 4
    end

    def follow_extensions():
        wanted = read_input_float_reg(18)
        if extension_state == 0:
            if wanted != 0:
                extension_id = wanted
                extension_state = 1
                write_output_float_reg(18, 0 - extension_id)
                extension_thrd = run extension_thread()
            end
        elif extension_state == 1:
            if wanted != extension_id:
                kill extension_thrd
                extension_state = 3
                extension_thrd = run extension_stop_thread()
            end
        elif extension_state == 2 and wanted == extension_id:
            write_output_float_reg(18, extension_id)
        elif extension_state == 2 or extension_state == 4 or (extension_state == 5 and wanted == 0):
            extension_state = 0
            extension_id = 0
            write_output_float_reg(18, 0)
        end
    end

)";

/// A mode of the arm that snippets can switch on.
struct SnippetMode {
  std::array<std::string_view, 2> starts;
  std::string_view condition;  ///< a command has not started it
  std::string_view end;
};
// Each controller that has a start has its end, so that these lines need no version marker.
constexpr std::array<SnippetMode, 3> snippet_modes{
    {{{"force_mode"}, "is_in_forcemode == 0 and ", "end_force_mode()"},
     {{"freedrive_mode", "freedrive_mode_no_incorrect_payload_check"}, "", "end_freedrive_mode()"},
     {{"teach_mode"}, "", "end_teach_mode()"}}};

Fault extension_fault(const ScriptExtension & extension, const Fault & fault, const char * part = "")
{
  const std::string where = fault.line > 0 ? fmt::format(", {}line {}", part, fault.line) : "";
  return {fault.line, fmt::format("extension `{}`{}: {}", extension.name, where, fault.message)};
}

bool is_name(std::string_view name)
{
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

/// Replaces version markers, which are not part of the language, by blanks.
std::string without_markers(std::string text)
{
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '$') {
      const auto end = std::min(text.find_first_of(" \n", i), text.size());
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(i),
                text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    }
  }
  return text;
}

bool starts(const SnippetMode & mode, const std::string & code)
{
  const std::string plain = without_markers(code);
  const auto scanned = scan(plain);
  const auto is_start = [&](const Token & token) {
    return token.kind == Token::Kind::word && std::ranges::find(mode.starts, token.text) != mode.starts.end();
  };
  return scanned && std::ranges::any_of(scanned->tokens, is_start);
}

/// Expands the short forms of registers and checks for code that the controller would reject.
Result<std::string> prepare(const ScriptExtension & extension, const std::string & text, const char * part,
                            ScriptRegisters & used)
{
  auto expanded = expand_registers(text, used);
  if (!expanded) {
    return tl::unexpected(extension_fault(extension, expanded.error(), part));
  }
  const std::string plain = without_markers(*expanded);
  const auto scanned = scan(plain);
  if (!scanned) {
    return tl::unexpected(extension_fault(extension, scanned.error(), part));
  }
  for (const Token & token : scanned->tokens) {
    if (token.is("halt")) {
      return tl::unexpected(
          extension_fault(extension, {token.line, "`halt` would end the control program"}, part));
    }
  }
  return expanded;
}

class Composer {
 public:
  Result<void> add(ScriptExtension extension)
  {
    const int id = first_id + static_cast<int>(parts_.size());
    ScriptRegisters used = extension.registers;
    const auto snippet = prepare(extension, extension.snippet, "", used);
    if (!snippet) {
      return tl::unexpected(snippet.error());
    }
    const auto preamble = prepare(extension, extension.preamble, "preamble ", used);
    if (!preamble) {
      return tl::unexpected(preamble.error());
    }
    if (const auto ok = check_registers(used); !ok) {
      return tl::unexpected(extension_fault(extension, ok.error()));
    }
    extension.registers = used;
    if (const auto ok = check_against_others(extension); !ok) {
      return ok;
    }
    add_preamble(extension, *preamble);
    parts_.push_back({extension, id, *snippet, *preamble});
    return {};
  }

  Result<ControlScript> into(const std::string & base)
  {
    for (const auto anchor : {before_commands, before_loop}) {
      if (const auto ok = check_anchor(base, anchor); !ok) {
        return tl::unexpected(ok.error());
      }
    }
    const std::size_t commands = base.find(before_commands);
    const std::size_t loop = base.find(before_loop);
    const auto line_at = [&](std::size_t offset) {
      return 1 + static_cast<int>(
                     std::count(base.begin(), base.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
    };
    const std::string_view text(base);
    result_.text.copy(text.substr(0, commands), 1);
    write_extensions();
    result_.text.copy(text.substr(commands, loop - commands), line_at(commands));
    result_.text.insert("            follow_extensions()");
    result_.text.copy(text.substr(loop), line_at(loop));
    return std::move(result_);
  }

 private:
  struct Part {
    ScriptExtension extension;
    int id;
    std::string snippet;
    std::string preamble;
  };

  Result<void> check_against_others(const ScriptExtension & extension) const
  {
    for (const Part & other : parts_) {
      if (other.extension.name == extension.name) {
        return fault(0, fmt::format("there are two extensions `{}`: leave one out", extension.name));
      }
      const bool same_preamble =
          !extension.preamble_name.empty() && extension.preamble_name == other.extension.preamble_name;
      if (same_preamble && extension.preamble != other.extension.preamble) {
        return fault(0, fmt::format("the extensions `{}` and `{}` define the preamble `{}` differently",
                                    other.extension.name, extension.name, extension.preamble_name));
      }
      const std::string common = common_register(extension.registers, other.extension.registers);
      if (!common.empty() && (extension.exclusive || other.extension.exclusive)) {
        return fault(0, fmt::format("the extensions `{}` and `{}` both use {}", other.extension.name,
                                    extension.name, common));
      }
    }
    return {};
  }

  Result<void> check_anchor(const std::string & base, std::string_view anchor) const
  {
    const auto first = base.find(anchor);
    if (first != std::string::npos && base.find(anchor, first + 1) == std::string::npos) {
      return {};
    }
    return fault(0, fmt::format("extension `{}` cannot be added: the control script has the line `{}` {}",
                                parts_.front().extension.name,
                                anchor.substr(anchor.find_first_not_of(' '),
                                              anchor.size() - anchor.find_first_not_of(' ') - 1),
                                first == std::string::npos ? "nowhere" : "more than once"));
  }

  void add_preamble(const ScriptExtension & extension, const std::string & text)
  {
    const auto same = [&](const Part & other) {
      return !extension.preamble_name.empty() && other.extension.preamble_name == extension.preamble_name;
    };
    if (!text.empty() && std::none_of(parts_.begin(), parts_.end(), same)) {
      preambles_.push_back({text, fmt::format("extension `{}`, preamble", extension.name)});
    }
  }

  struct Lines {
    std::string text;
    std::string source;
  };

  void write_lines(const Lines & lines)
  {
    result_.sources.push_back(lines.source);
    result_.text.end_line();
    result_.text.copy(lines.text, 1, result_.sources.size() - 1);
    result_.text.end_line();
  }

  void write_extensions()
  {
    result_.sources.emplace_back("control script");
    for (const Lines & preamble : preambles_) {
      write_lines(preamble);
    }
    std::string choice;
    for (const Part & part : parts_) {
      result_.ids[part.extension.name] = part.id;
      result_.text.insert(fmt::format("    def extension_{}(): # {}", part.id, part.extension.name));
      write_lines({part.snippet, fmt::format("extension `{}`", part.extension.name)});
      result_.text.insert("    end");
      choice += fmt::format("        {} extension_id == {}:\n            extension_{}()\n",
                            choice.empty() ? "if" : "elif", part.id, part.id);
    }
    choice += "        end\n";
    result_.text.insert(fmt::format(fmt::runtime(dispatcher), fmt::arg("choice", choice),
                                    fmt::arg("mode_ends", mode_ends())));
  }

  /// The modes that an extension switches on end with it. It leaves a mode alone that its code does not
  /// start: a command has started it.
  std::string mode_ends() const
  {
    std::string result;
    for (const SnippetMode & mode : snippet_modes) {
      // Each snippet may call the functions of each preamble.
      const bool in_preamble =
          std::ranges::any_of(parts_, [&](const Part & part) { return starts(mode, part.preamble); });
      std::string ids;
      for (const Part & part : parts_) {
        if (in_preamble || starts(mode, part.snippet)) {
          ids += fmt::format("{}extension_id == {}", ids.empty() ? "" : " or ", part.id);
        }
      }
      if (!ids.empty()) {
        result +=
            fmt::format("        if {}({}):\n            {}\n        end\n", mode.condition, ids, mode.end);
      }
    }
    return result;
  }

  std::vector<Part> parts_;
  std::vector<Lines> preambles_;
  ControlScript result_;
};

bool has_version(std::string_view marker, unsigned major, unsigned minor)
{
  const auto dot = marker.find('.');
  const auto number = [](std::string_view text) {
    unsigned value = 0;
    for (const char c : text) {
      value = c >= '0' && c <= '9' ? 10 * value + static_cast<unsigned>(c - '0') : value;
    }
    return value;
  };
  const unsigned needed = number(marker.substr(0, dot));
  const unsigned needed_minor = number(marker.substr(dot + 1));
  return major == needed && minor >= needed_minor;
}

/// `$5.10|3.15 …`: from PolyScope 5.10 on, on a CB3 from 3.15 on. A later major version includes the earlier
/// ones.
bool applies_to(std::string_view marker, unsigned major, unsigned minor)
{
  const auto bar = marker.find('|');
  const std::string_view first = marker.substr(0, bar);
  const unsigned first_major = static_cast<unsigned>(first.front() - '0');
  return major > first_major || has_version(first, major, minor) ||
         (bar != std::string_view::npos && has_version(marker.substr(bar + 1), major, minor));
}

}  // namespace

Result<ControlScript> compose(const std::string & base, std::vector<ScriptExtension> extensions)
{
  if (extensions.empty()) {
    ControlScript script;
    script.sources = {"control script"};
    script.text.copy(base, 1);
    return script;
  }
  std::sort(extensions.begin(), extensions.end(),
            [](const ScriptExtension & a, const ScriptExtension & b) { return a.name < b.name; });
  Composer composer;
  for (ScriptExtension & extension : extensions) {
    if (!is_name(extension.name)) {
      return fault(
          0,
          fmt::format("`{}` is not a valid name of an extension: use lower case letters, digits, underscores",
                      extension.name));
    }
    if (const auto added = composer.add(std::move(extension)); !added) {
      return tl::unexpected(added.error());
    }
  }
  return composer.into(base);
}

Result<ControlScript> for_controller(const ControlScript & script, unsigned major, unsigned minor,
                                     bool upper_range_registers)
{
  constexpr std::string_view offset = "register offset\n";
  ControlScript result{{}, script.sources, script.ids};
  const std::string_view text = script.text.text();
  int number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    std::string line(text.substr(begin, end - begin));
    begin = end;
    const Origin origin = script.text.origin(number);
    if (line.front() == '$') {
      const auto marker = line.substr(1, line.find_first_of(" \n") - 1);
      if (marker.size() < 3 || !applies_to(marker, major, minor)) {
        continue;
      }
      line.replace(0, marker.size() + 1, marker.size() + 1, ' ');
    } else if (line.find('#') != std::string::npos && line.size() > offset.size() &&
               line.compare(line.size() - offset.size(), offset.size(), offset) == 0) {
      line = line.substr(0, line.find('#')) + (upper_range_registers ? "24\n" : "0\n");
    }
    if (origin.line > 0) {
      result.text.copy(line, origin.line, origin.source);
    } else {
      result.text.insert(line);
    }
  }
  if (const auto scanned = scan(result.text.text()); !scanned) {
    const std::string where = place(result, scanned.error().line);
    return fault(scanned.error().line, fmt::format("{}: {}", where.empty() ? "the control script" : where,
                                                   scanned.error().message));
  }
  return result;
}

std::string place(const ControlScript & script, int line)
{
  const Origin origin = script.text.origin(line);
  if (origin.source == 0 || origin.line == 0 || origin.source >= script.sources.size()) {
    return {};
  }
  return fmt::format("{}, line {}", script.sources[origin.source], origin.line);
}

}  // namespace ur_ros_rtde::script
