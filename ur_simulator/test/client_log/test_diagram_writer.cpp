#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "client_log/diagram_writer.hpp"
#include "support/sequence_diagram.hpp"
#include "support/temporary_file.hpp"

namespace ur_simulator::testing {
namespace {

std::string content_of(const std::string & path)
{
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(DiagramWriterTest, WritesAllLinesUntilItsEnd)
{
  const TemporaryFile file("lines");
  {
    DiagramWriter writer(file.path());
    writer.add("participant robot");
    writer.add("Note over robot: [0.002] started");
  }
  EXPECT_EQ(content_of(file.path()),
            "sequenceDiagram\nparticipant robot\nNote over robot: [0.002] started\n");
}

TEST(DiagramWriterTest, NamesFileThatCannotBeOpened)
{
  try {
    const DiagramWriter writer("/nonexistent/log.mmd");
    FAIL();
  } catch (const std::runtime_error & error) {
    EXPECT_EQ(
        std::string(error.what()),
        "client log '/nonexistent/log.mmd' cannot be written (--client-log): No such file or directory");
  }
}

TEST(DiagramWriterTest, ReportsFullDiskOnceAndDiscardsLines)
{
  ::testing::internal::CaptureStderr();
  {
    DiagramWriter writer("/dev/full");
    for (int i = 0; i < 1000; ++i) {
      writer.add("Note over robot: [0.002] line");
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "ur_simulator: the client log ends: /dev/full cannot be written: No space left on device\n");
}

TEST(DiagramWriterTest, LeavesLinesOutWhileReaderIsSlow)
{
  const TemporaryFile pipe("pipe");
  ASSERT_EQ(mkfifo(pipe.path().c_str(), 0600), 0);
  std::ifstream reader;
  constexpr int lines = 20000;
  const std::string line(200, 'x');  // together, more than the queue and the pipe contain
  std::thread reading;
  {
    const int keep_open = open(pipe.path().c_str(), O_RDWR | O_CLOEXEC);
    DiagramWriter writer(pipe.path());
    for (int i = 0; i < lines; ++i) {
      writer.add(line);
    }
    reader.open(pipe.path());
    close(keep_open);
    reading = std::thread([&] {
      int written = 0;
      int left_out = 0;
      std::string read;
      for (std::getline(reader, read); std::getline(reader, read);) {
        written += read == line ? 1 : 0;
        left_out += read.starts_with("%% ") ? std::stoi(read.substr(3)) : 0;
      }
      EXPECT_GT(left_out, 0);
      EXPECT_EQ(written + left_out, lines);
    });
  }
  reading.join();
}

}  // namespace
}  // namespace ur_simulator::testing
