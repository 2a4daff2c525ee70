#include "script_api/function_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace ur_simulator {

namespace {

/// Names with the same note, in the order of their first appearance.
using NameTable = std::vector<std::pair<std::string, std::vector<std::string>>>;

void add_name(NameTable & table, const std::string & note, const std::string & name)
{
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto & row) { return row.first == note; });
  if (found == table.end()) {
    table.push_back({note, {name}});
  } else {
    found->second.push_back(name);
  }
}

std::string code_list(const std::vector<std::string> & names)
{
  return fmt::format("`{}`", fmt::join(names, " "));
}

}  // namespace

std::string function_reference(const urscript::Library & library)
{
  NameTable simplifications;
  NameTable rejections;
  for (std::uint32_t i = 0; i < library.size(); ++i) {
    const urscript::Builtin & builtin = library[i];
    if (builtin.support != urscript::Support::modelled) {
      add_name(builtin.support == urscript::Support::simplified ? simplifications : rejections, builtin.note,
               builtin.name);
    }
  }
  std::string text = "| simplified functions | simplification |\n|---|---|\n";
  for (const auto & [note, names] : simplifications) {
    text += fmt::format("| {} | {} |\n", code_list(names), note);
  }
  text += "\n| rejected functions | reason |\n|---|---|\n";
  for (const auto & [reason, names] : rejections) {
    text += fmt::format("| {} | {} |\n", code_list(names), reason);
  }
  return text;
}

}  // namespace ur_simulator
