#include <gtest/gtest.h>

#include <string>

#include "ur_ros_rtde_robot/connection/text.hpp"

using ur_ros_rtde::printable;

TEST(PrintableTest, KeepsValidText)
{
  EXPECT_EQ(printable("Robotmode: RUNNING"), "Robotmode: RUNNING");
  EXPECT_EQ(printable("zwei\n\tGrüße, 2 µm, 手"), "zwei\n\tGrüße, 2 µm, 手");
  EXPECT_EQ(printable(""), "");
}

TEST(PrintableTest, ReplacesInvalidBytesByQuestionMarks)
{
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\x1b[31m\x7f"), "?[31m?");
  EXPECT_EQ(printable("\xff\xfe ok"), "?? ok");
  EXPECT_EQ(printable("cut off \xe6\x89"), "cut off ??");
  EXPECT_EQ(printable("\xc0\x80"), "??") << "an overlong zero";
  EXPECT_EQ(printable("\xed\xa0\x80"), "???") << "half a surrogate pair";
}
