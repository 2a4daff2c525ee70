#include "client_log/text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace ur_simulator {

std::string printable(std::string_view text, std::size_t limit)
{
  std::string line;
  for (const char character : text.substr(0, limit)) {
    switch (character) {
      case '\n':
        line += "\\n";
        break;
      case '\r':
        line += "\\r";
        break;
      case '\t':
        line += "\\t";
        break;
      case '\\':
        line += "\\\\";
        break;
      default:
        if (character >= ' ' && character <= '~') {
          line += character;
        } else {
          fmt::format_to(std::back_inserter(line), "\\x{:02x}", static_cast<unsigned char>(character));
        }
    }
  }
  if (text.size() > limit) {
    line += fmt::format(" ... ({} more bytes)", text.size() - limit);
  }
  return line;
}

std::string escape_mermaid(std::string_view text)
{
  // '#' and ';' end a text, '<' begins a tag, "%%" a comment or directive, "$$" a formula.
  constexpr std::string_view special = "#;<>%$";
  std::string escaped;
  for (const char character : text) {
    if (special.find(character) == std::string_view::npos) {
      escaped += character;
    } else {
      fmt::format_to(std::back_inserter(escaped), "#{};", static_cast<int>(character));
    }
  }
  return escaped;
}

}  // namespace ur_simulator
