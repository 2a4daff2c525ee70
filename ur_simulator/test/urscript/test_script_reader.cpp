#include <gtest/gtest.h>

#include "urscript/script_reader.hpp"

namespace ur_simulator::urscript {
namespace {

TEST(ScriptReaderTest, ReturnsAProgramAtItsEnd)
{
  ScriptReader reader;
  reader.feed("def a():\n  if True:\n    x = 1\n  end\nend\nmovej([0,0,0,0,0,0])\nsec b():\nend\n");
  EXPECT_EQ(reader.next(), "def a():\n  if True:\n    x = 1\n  end\nend\n");
  EXPECT_EQ(reader.next(), "movej([0,0,0,0,0,0])\n");
  EXPECT_EQ(reader.next(), "sec b():\nend\n");
  EXPECT_EQ(reader.next(), std::nullopt);
}

TEST(ScriptReaderTest, WaitsForTheRestForAnyFragmentation)
{
  const std::string program = "def a():\n thread t():\n  while True:\n sync()\n end\n end\nend\n";
  ScriptReader reader;
  for (std::size_t i = 0; i + 1 < program.size(); ++i) {
    reader.feed(program.substr(i, 1));
    ASSERT_EQ(reader.next(), std::nullopt) << i;
  }
  reader.feed("\n");
  EXPECT_EQ(reader.next(), program);
  EXPECT_EQ(reader.pending(), 0U);
}

TEST(ScriptReaderTest, IgnoresBlockKeywordsInCommentsAndStrings)
{
  ScriptReader reader;
  const std::string program = "def a():\n # the end\n x = \"end if def\"\n end_it = 1\nend\r\n";
  reader.feed(program);
  EXPECT_EQ(reader.next(), program);
}

TEST(ScriptReaderTest, SkipsBlankLinesAndCommentsBetweenPrograms)
{
  ScriptReader reader;
  reader.feed("\n\n  # hello\r\n\nstopj(2)\n");
  EXPECT_EQ(reader.next(), "stopj(2)\n");
}

TEST(ScriptReaderTest, DropsAProgramAboveTheLimitUpToItsEnd)
{
  ScriptReader reader(1000);
  reader.feed("def a():\n");
  for (int i = 0; i < 500; ++i) {
    reader.feed("  x = 1\n");
    ASSERT_EQ(reader.next(), std::nullopt);
    ASSERT_LE(reader.pending(), 1010U);
  }
  EXPECT_EQ(reader.dropped(), 1U);
  reader.feed("end\nstopj(2)\n");
  EXPECT_EQ(reader.next(), "stopj(2)\n");
}

TEST(ScriptReaderTest, IgnoresInputAfterALineAboveTheLimit)
{
  ScriptReader reader(1000);
  reader.feed(std::string(2000, 'x'));
  EXPECT_EQ(reader.next(), std::nullopt);
  EXPECT_EQ(reader.dropped(), 1U);
  reader.feed("\nstopj(2)\n");
  EXPECT_EQ(reader.next(), std::nullopt);
  EXPECT_EQ(reader.pending(), 0U);
}

TEST(ScriptReaderTest, ResetDiscardsTheIncompleteProgram)
{
  ScriptReader reader;
  reader.feed("def a():\n x = 1\n");
  EXPECT_EQ(reader.next(), std::nullopt);
  reader.reset();
  reader.feed("stopj(2)\n");
  EXPECT_EQ(reader.next(), "stopj(2)\n");
}

}  // namespace
}  // namespace ur_simulator::urscript
