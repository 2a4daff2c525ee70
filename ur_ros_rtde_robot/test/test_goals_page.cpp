#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "ur_ros_rtde_robot/motion/motion.hpp"

namespace ur_ros_rtde::test {
namespace {

/// The names in backticks at the beginning of the numbered lines below the heading.
std::vector<std::string> documented_means()
{
  std::ifstream file(GOALS_PAGE);
  EXPECT_TRUE(file) << GOALS_PAGE;
  std::vector<std::string> names;
  bool below = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) {
      below = line == "## Means of a stop";
    }
    const std::string begin = std::to_string(names.size() + 1) + ". `";
    if (below && line.starts_with(begin)) {
      names.push_back(line.substr(begin.size(), line.find('`', begin.size()) - begin.size()));
    }
  }
  return names;
}

TEST(GoalsPageTest, ListsTheMeansOfAStopInTheirOrder)
{
  std::vector<std::string> means;
  for (const StopMeans next : {StopMeans::nothing_moved, StopMeans::stopped_by_robot, StopMeans::stop_command,
                               StopMeans::program_stopped, StopMeans::watchdog}) {
    EXPECT_EQ(static_cast<std::size_t>(next), means.size());
    means.emplace_back(to_string(next));
  }
  EXPECT_EQ(documented_means(), means);
}

}  // namespace
}  // namespace ur_ros_rtde::test
