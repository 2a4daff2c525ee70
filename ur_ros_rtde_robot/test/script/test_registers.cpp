// Compares the table of registers in docs/use/writing_a_plugin.md with the code.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "script/registers.hpp"

namespace ur_ros_rtde::script {
namespace {

using Numbers = std::set<int>;

constexpr int register_count = 48;
constexpr int upper_range_offset = 24;

const std::map<std::string, std::vector<int> ScriptRegisters::*> lists{
    {"input integer", &ScriptRegisters::input_int},
    {"input float", &ScriptRegisters::input_double},
    {"output integer", &ScriptRegisters::output_int},
    {"output float", &ScriptRegisters::output_double}};
const std::map<std::string, std::string> short_forms{{"input integer", "$in{}i"},
                                                     {"input float", "$in{}f"},
                                                     {"output integer", "$out{}i(1)"},
                                                     {"output float", "$out{}f(1)"}};

/// "12–17, 19"
Numbers numbers(const std::string & cell)
{
  static const std::regex range("(\\d+)(?:–(\\d+))?");
  Numbers result;
  for (std::sregex_iterator at(cell.begin(), cell.end(), range), end; at != end; ++at) {
    const int first = std::stoi((*at)[1]);
    const int last = (*at)[2].matched ? std::stoi((*at)[2]) : first;
    for (int number = first; number <= last; ++number) {
      result.insert(number);
    }
  }
  return result;
}

struct Row {
  Numbers free, free_upper, used;
};

/// Key: kind of register.
std::map<std::string, Row> table()
{
  std::ifstream file(DOCUMENT);
  static const std::regex row(R"(\| (\w+put \w+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|)");
  std::map<std::string, Row> rows;
  std::smatch cells;
  for (std::string line; std::getline(file, line);) {
    if (std::regex_match(line, cells, row)) {
      rows[cells[1]] = {numbers(cells[2]), numbers(cells[3]), numbers(cells[4])};
    }
  }
  return rows;
}

Numbers free_in_code(const std::string & kind)
{
  Numbers free;
  for (int number = 0; number < register_count; ++number) {
    ScriptRegisters used;
    (used.*lists.at(kind)).push_back(number);
    if (check_registers(used)) {
      free.insert(number);
    }
    std::string text = short_forms.at(kind);
    text.replace(text.find("{}"), 2, std::to_string(number));
    ScriptRegisters expanded;
    EXPECT_EQ(check_registers(used).has_value(), expand_registers(text, expanded).has_value()) << text;
  }
  return free;
}

TEST(RegisterTable, HasARowForEachKind)
{
  const auto rows = table();
  for (const auto & [kind, list] : lists) {
    EXPECT_EQ(rows.count(kind), 1U) << kind;
  }
}

TEST(RegisterTable, NamesTheRegistersThatExtensionsMayUse)
{
  for (const auto & [kind, row] : table()) {
    EXPECT_EQ(row.free, free_in_code(kind)) << kind;
  }
}

TEST(RegisterTable, NamesTheSameOnesOfTheUpperRange)
{
  for (const auto & [kind, row] : table()) {
    Numbers moved;
    for (const int number : row.free) {
      moved.insert(number + upper_range_offset);
    }
    EXPECT_EQ(row.free_upper, moved) << kind;
  }
}

TEST(RegisterTable, GivesNoRegisterToTwo)
{
  for (const auto & [kind, row] : table()) {
    for (const int number : row.used) {
      EXPECT_EQ(row.free.count(number), 0U) << kind << " " << number;
    }
  }
}

}  // namespace
}  // namespace ur_ros_rtde::script
