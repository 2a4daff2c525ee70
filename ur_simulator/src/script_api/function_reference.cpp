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

std::string note_rows(const NameTable & table)
{
  std::string text;
  for (const auto & [note, names] : table) {
    std::string second = note;
    for (const std::string & cell : code_cells(names)) {
      text += fmt::format("| {} | {} |\n", cell, std::exchange(second, ""));
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> code_cells(const std::vector<std::string> & names)
{
  constexpr std::size_t width = 118;  // between the two backticks
  std::vector<std::string> cells;
  for (const std::string & name : names) {
    if (cells.empty() || cells.back().size() + 1 + name.size() > width) {
      cells.push_back(name);
    } else {
      cells.back() += " " + name;
    }
  }
  for (std::string & cell : cells) {
    cell = fmt::format("`{}`", cell);
  }
  return cells;
}

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
  return "| simplified functions | simplification |\n|---|---|\n" + note_rows(simplifications) +
         "\n| rejected functions | reason |\n|---|---|\n" + note_rows(rejections);
}

}  // namespace ur_simulator
