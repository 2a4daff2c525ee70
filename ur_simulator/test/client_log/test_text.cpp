#include <gtest/gtest.h>

#include "client_log/text.hpp"

namespace ur_simulator {
namespace {

TEST(PrintableTest, EscapesWhatIsNotPrintable)
{
  EXPECT_EQ(printable("a\nb\r\tc", 100), "a\\nb\\r\\tc");
  EXPECT_EQ(printable(std::string_view("\x1b[2J\0\x7f\xc3\xbc", 8), 100), "\\x1b[2J\\x00\\x7f\\xc3\\xbc");
  EXPECT_EQ(printable("\\n", 100), "\\\\n");
}

TEST(PrintableTest, CountsOmittedBytes)
{
  EXPECT_EQ(printable("abcde", 5), "abcde");
  EXPECT_EQ(printable("abcdefg", 5), "abcde ... (2 more bytes)");
}

TEST(EscapeMermaidTest, EscapesCharactersWithMeaning)
{
  EXPECT_EQ(escape_mermaid("a; b#c"), "a#59; b#35;c");
  EXPECT_EQ(escape_mermaid("%%{init: {}}%%"), "#37;#37;{init: {}}#37;#37;");
  EXPECT_EQ(escape_mermaid("<br/> $$x$$"), "#60;br/#62; #36;#36;x#36;#36;");
  EXPECT_EQ(escape_mermaid("movej([0, 1], a=3): end"), "movej([0, 1], a=3): end");
}

}  // namespace
}  // namespace ur_simulator
