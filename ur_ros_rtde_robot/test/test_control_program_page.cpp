#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "program/program_state_machine.hpp"

namespace ur_ros_rtde::test {
namespace {

template <class T>
std::vector<T> all(std::size_t count)
{
  std::vector<T> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<T>(i));
  }
  return values;
}

/// The rows of the first Markdown table below the heading, without its header: the cells.
std::vector<std::vector<std::string>> documented_table(const std::string & heading)
{
  std::ifstream file(CONTROL_PROGRAM_PAGE);
  EXPECT_TRUE(file) << CONTROL_PROGRAM_PAGE;
  std::vector<std::vector<std::string>> rows;
  bool below = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) {
      below = line == heading;
    }
    if (!below || !line.starts_with('|')) {
      continue;
    }
    std::vector<std::string> cells;
    std::istringstream stream(line.substr(1));
    for (std::string cell; std::getline(stream, cell, '|');) {
      std::erase(cell, '`');
      const auto begin = cell.find_first_not_of(' ');
      cells.push_back(
          begin == std::string::npos ? "" : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
    }
    rows.push_back(cells);
  }
  if (rows.size() >= 2) {
    rows.erase(rows.begin(), rows.begin() + 2);
  }
  return rows;
}

std::set<std::string> first_cells(const std::vector<std::vector<std::string>> & rows)
{
  std::set<std::string> result;
  for (const auto & row : rows) {
    result.insert(row.front());
  }
  return result;
}

template <class T>
std::set<std::string> names_of(const std::vector<T> & values)
{
  std::set<std::string> result;
  for (const auto value : values) {
    result.insert(to_string(value));
  }
  return result;
}

TEST(ControlProgramPageTest, ListsEveryTransitionInOrder)
{
  const auto documented = documented_table("## Transitions");
  std::vector<std::vector<std::string>> expected;
  for (const auto & transition : program_transitions()) {
    const bool acts = transition.action != ProgramAction::none;
    expected.push_back({to_string(transition.from), to_string(transition.event), to_string(transition.guard),
                        to_string(transition.to), acts ? to_string(transition.action) : ""});
  }
  EXPECT_EQ(documented, expected);
}

TEST(ControlProgramPageTest, ExplainsEveryStateEventAndAction)
{
  auto actions = all<ProgramAction>(program_action_count);
  actions.erase(actions.begin());
  EXPECT_EQ(first_cells(documented_table("## States")), names_of(all<ProgramState>(program_state_count)));
  EXPECT_EQ(first_cells(documented_table("## Events")), names_of(all<ProgramEvent>(program_event_count)));
  EXPECT_EQ(first_cells(documented_table("## Actions")), names_of(actions));
}

}  // namespace
}  // namespace ur_ros_rtde::test
