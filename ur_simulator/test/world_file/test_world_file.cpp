#include <gtest/gtest.h>

#include "support/temporary_file.hpp"
#include "world_file/world_file.hpp"

namespace ur_simulator {
namespace {

using testing::TemporaryFile;

WorldFile read(const std::string & text)
{
  return read_world_file(TemporaryFile("world.yaml", text).path());
}

/// The message after the path: ":line: text".
std::string error_of(const std::string & text)
{
  const TemporaryFile file("world.yaml", text);
  try {
    read_world_file(file.path());
    return "no error";
  } catch (const std::runtime_error & error) {
    const std::string message = error.what();
    return message.starts_with(file.path()) ? message.substr(file.path().size()) : message;
  }
}

TEST(WorldFileTest, EmptyFileHasNoObjectsAndEvents)
{
  for (const char * text : {"", "# nothing\n", "surfaces:\nevents: []\n"}) {
    const WorldFile file = read(text);
    EXPECT_TRUE(file.objects.empty() && file.events.empty()) << text;
  }
}

TEST(WorldFileTest, ReadsObjectsAndSortsEventsByTime)
{
  const WorldFile file = read(R"(surfaces:
  - {z: 0.1, stiffness: 5000}
boxes:
  - center: [0.5, 0, 0.2]
    size: [0.1, 0.2, 0.4]
springs: [{anchor: [0, 0, 1], stiffness: 100}]
load: {mass: 2.5}
events:
  - {at: 2, command: protective_stop}
  - {at: 0.5, command: push, force: [0, 30, 0]}
  - at: 2.0
    command: power
    to: 'off'
)");
  ASSERT_EQ(file.objects.size(), 4U);
  EXPECT_TRUE(file.objects[1].origin.ends_with(".yaml:4: place_box")) << file.objects[1].origin;
  ASSERT_EQ(file.events.size(), 3U);
  EXPECT_TRUE(file.events[0].origin.ends_with(":10: push")) << file.events[0].origin;
  EXPECT_EQ(file.events[0].time, 0.5);
  EXPECT_TRUE(file.events[1].origin.ends_with(":9: protective_stop"));
  EXPECT_TRUE(file.events[2].origin.ends_with(":11: power"));
}

TEST(WorldFileTest, ErrorsNameLineFieldAndValue)
{
  EXPECT_EQ(error_of("surfaces:\n  - z: 0.1\n    stifness: 5\n"),
            ":3: field 'stifness' is not known to this command: see \"help\"");
  EXPECT_EQ(error_of("surfaces:\n  - z: high\n"), ":2: field 'z' is \"high\": it must be a number");
  EXPECT_EQ(error_of("boxes:\n  - center: [0, 0, 0]\n    size: [1, -1, 1]\n"),
            ":3: field 'size[1]' is -1: it must be between 0.001 and 20");
  EXPECT_EQ(error_of("load:\n  center_of_gravity: [0, 0, 0]\n"), ":2: field 'mass' is missing");
  EXPECT_EQ(error_of("events:\n  - {command: push, force: [0, 1, 0]}\n"), ":2: field 'at' is missing");
  EXPECT_EQ(error_of("events:\n  - {at: -1, command: play}\n"),
            ":2: field 'at' is -1: it must be between 0 and 10000000");
  EXPECT_EQ(error_of("events:\n  - at: 1\n    command: fly\n"),
            ":3: command 'fly' is not known: \"help\" lists all commands");
  EXPECT_EQ(error_of("surfaces:\n  - {normal: [0, 0, 0], z: 0}\n"),
            ":2: field 'normal' is [0, 0, 0]: it must be a direction");
}

TEST(WorldFileTest, ErrorsOfTheStructureNameTheLine)
{
  EXPECT_EQ(error_of("tables: []\n"),
            ":1: section 'tables' is not known: it must be one of surfaces, boxes, springs, load, events");
  EXPECT_EQ(error_of("events: []\nload: {mass: 1}\nevents: []\n"),
            ":3: section 'events' is given twice: combine them");
  EXPECT_EQ(error_of("surfaces: {z: 0.1}\n"),
            ":1: section 'surfaces' must be a list: begin each entry with '- '");
  EXPECT_EQ(error_of("boxes:\n  - 5\n"), ":2: the entry is 5: it must consist of fields, name: value");
  EXPECT_EQ(error_of("- 1\n"), ":1: the file must consist of sections, such as surfaces: or events:");
  EXPECT_EQ(error_of("surfaces:\n  - {z: 0.1, command: push}\n"),
            ":2: field 'command' is not known in section 'surfaces'");
  EXPECT_TRUE(error_of("a: [1\nb: 2\n").starts_with(":2: no valid YAML: ")) << error_of("a: [1\nb: 2\n");
}

TEST(WorldFileTest, RejectsTextThatIsNotUtf8)
{
  const std::string message = ": the text is not UTF-8: save the file with this encoding";
  EXPECT_EQ(error_of("boxes: []\nsurfaces:\n  - {z: \xd1}\n"), ":3" + message);
  EXPECT_EQ(error_of("load: {m\xff: 1}\n"), ":1" + message);
  EXPECT_EQ(error_of("boxes:\n  - \xc3\x28\n"), ":2" + message);
  EXPECT_EQ(error_of("load: {mass: 1, m\u00e4ss: 2}\n"),
            ":1: field 'm\u00e4ss' is not known to this command: see \"help\"");
}

TEST(WorldFileTest, ErrorOfAFileThatCannotBeReadNamesTheOption)
{
  try {
    read_world_file("/no/such/file.yaml");
    FAIL() << "accepted";
  } catch (const std::runtime_error & error) {
    EXPECT_STREQ(error.what(),
                 "world file '/no/such/file.yaml' (--world) cannot be read: No such file or directory");
  }
  EXPECT_THROW(read_world_file("/tmp"), std::runtime_error);
}

TEST(WorldFileTest, LimitsTheSizeOfTheFile)
{
  EXPECT_NE(error_of(std::string(1024 * 1024 + 1, '#')).find("more than 1048576 bytes"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator
