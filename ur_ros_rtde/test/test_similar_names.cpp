#include <gtest/gtest.h>

#include "plugins/similar_names.hpp"

namespace ur_ros_rtde {
namespace {

const std::vector<std::string> names = {"on_busy", "qos", "robot_ip", "ur_type", "watchdog_frequency"};

TEST(SimilarNamesTest, FindsTheNameWithATypingError)
{
  EXPECT_EQ(most_similar("on_busi", names), "on_busy");
  EXPECT_EQ(most_similar("robotip", names), "robot_ip");
  EXPECT_EQ(most_similar("watch_dog_frequncy", names), "watchdog_frequency");
  EXPECT_EQ(most_similar("qoss", names), "qos");
  EXPECT_EQ(most_similar("ur_type", names), "ur_type");
}

TEST(SimilarNamesTest, FindsNothingForADifferentName)
{
  EXPECT_EQ(most_similar("use_sim_time", names), std::nullopt);
  EXPECT_EQ(most_similar("robot", names), std::nullopt);
  EXPECT_EQ(most_similar("", names), std::nullopt);
  EXPECT_EQ(most_similar("on_busy", {}), std::nullopt);
}

}  // namespace
}  // namespace ur_ros_rtde
