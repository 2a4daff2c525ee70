#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>
#include <string>

#include "connection/primary_connection.hpp"
#include "primary_messages.hpp"

namespace ur_ros_rtde {
namespace {

using namespace test::primary;

bool feed(PrimaryReader & reader, const std::string & bytes)
{
  return reader.feed(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

TEST(PrimaryReaderTest, FindsMessagesInAStreamSplitAnywhere)
{
  const std::string stream = package(3, "version") + package(0, "hello") + big_endian(9) + "\x10" + "four" +
                             exception(4, "compile_error_name_not_found:f:") +
                             key("PROGRAM_XXX_STARTED", "mine") + key("PROGRAM_XXX_STOPPED", "mine");
  for (std::size_t cut = 1; cut < 20; ++cut) {
    PrimaryReader reader;
    for (std::size_t i = 0; i < stream.size(); i += cut) {
      ASSERT_TRUE(feed(reader, stream.substr(i, cut)));
    }
    const auto text = reader.next();
    ASSERT_TRUE(text);
    EXPECT_EQ(text->kind, PrimaryMessage::Kind::text);
    EXPECT_EQ(text->text, "hello");
    const auto error = reader.next();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->kind, PrimaryMessage::Kind::error);
    EXPECT_EQ(error->line, 4);
    EXPECT_EQ(reader.next()->kind, PrimaryMessage::Kind::program_started);
    EXPECT_EQ(reader.next()->text, "mine");
    EXPECT_FALSE(reader.next());
  }
}

TEST(PrimaryReaderTest, ReadsTheLineFromTheTextIfTheFieldIsEmpty)
{
  PrimaryReader reader;
  ASSERT_TRUE(feed(reader, exception(0xFFFFFFFFU, "syntax_error_on_line:12:end:") +
                               exception(0xFFFFFFFFU, "program 'f' failed in line 7: no") +
                               exception(0, "no number") + exception(0, "line")));
  for (const int line : {12, 7, 0, 0}) {
    EXPECT_EQ(reader.next()->line, line);
  }
}

TEST(PrimaryReaderTest, ReadsTheErrorCodesOfViolationsAndFaults)
{
  const auto error_code = [](std::uint32_t level) {
    return package(6, big_endian(204) + big_endian(5) + big_endian(level) + big_endian(0) + big_endian(0) +
                          "the path leads out of the robot's reach");
  };
  PrimaryReader reader;
  ASSERT_TRUE(feed(reader, error_code(1) + error_code(2) + error_code(3) + package(6, "short")));
  const auto message = reader.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->kind, PrimaryMessage::Kind::error_code);
  EXPECT_EQ(message->text, "C204A5: the path leads out of the robot's reach");
  EXPECT_FALSE(reader.next());
}

TEST(PrimaryReaderTest, SkipsMessagesThatAreTooShort)
{
  PrimaryReader reader;
  EXPECT_TRUE(feed(reader, package(10, "abc") + package(7, "abc") +
                               package(7, std::string(8, '\0') + "\x20") + big_endian(5) + "\x14" +
                               package(0, "still there")));
  EXPECT_EQ(reader.next()->text, "still there");
}

TEST(PrimaryReaderTest, RejectsOtherStreams)
{
  for (const std::uint32_t size : {0U, 4U, 2'000'000U, 0xFFFFFFFFU}) {
    PrimaryReader reader;
    EXPECT_FALSE(feed(reader, big_endian(size) + "\x14zzzz")) << size;
  }
}

std::string number(double value)
{
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return big_endian(static_cast<std::uint32_t>(bits >> 32U)) + big_endian(static_cast<std::uint32_t>(bits));
}

std::string state_package(char type, const std::string & content)
{
  return big_endian(static_cast<std::uint32_t>(content.size() + 5)) + type + content;
}

std::string robot_state(const std::string & packages)
{
  return big_endian(static_cast<std::uint32_t>(packages.size() + 5)) + "\x10" + packages;
}

/// Configuration data with a robot type.
std::string configuration(std::uint32_t type)
{
  return state_package(6, std::string(8 * 53 + 8, '\0') + big_endian(type) + big_endian(2));
}

/// Kinematics data in which the n-th number is n, except for the number at `index`.
std::string kinematics_data(std::size_t index, double value)
{
  std::string content(24, '\x7f');
  for (std::size_t i = 0; i < 24; ++i) {
    content += number(i == index ? value : static_cast<double>(i));
  }
  return state_package(5, content + big_endian(0));
}

TEST(PrimaryReaderTest, ReadsTypeAndCalibrationOfTheArm)
{
  PrimaryReader reader;
  ASSERT_TRUE(feed(reader, robot_state(state_package(0, "mode"))));
  EXPECT_FALSE(reader.arm_data());
  ASSERT_TRUE(feed(reader, robot_state(kinematics_data(8, -0.5) + configuration(2))));
  ASSERT_TRUE(reader.arm_data() && reader.arm_data()->dh_rows);
  EXPECT_EQ(reader.arm_data()->type, 2);
  const auto & row = (*reader.arm_data()->dh_rows)[2];
  EXPECT_EQ(row.theta, 2.0);
  EXPECT_EQ(row.a, -0.5);
  EXPECT_EQ(row.d, 14.0);
  EXPECT_EQ(row.alpha, 20.0);
}

TEST(PrimaryReaderTest, HasNoCalibrationIfItIsMissingOrInvalid)
{
  for (const std::string & kinematics : {std::string(), state_package(5, "short"),
                                         kinematics_data(3, std::numeric_limits<double>::quiet_NaN())}) {
    PrimaryReader reader;
    ASSERT_TRUE(feed(reader, robot_state(kinematics + configuration(1))));
    ASSERT_TRUE(reader.arm_data());
    EXPECT_FALSE(reader.arm_data()->dh_rows);
  }
}

TEST(PrimaryReaderTest, SurvivesArbitraryBytes)
{
  std::mt19937 random(4);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = exception(1, "text") + key("PROGRAM_XXX_STARTED", "f") + package(0, "a") +
                        robot_state(configuration(1) + kinematics_data(0, 1.0));
    for (int i = 0; i < 20; ++i) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    PrimaryReader reader;
    feed(reader, bytes);
    while (reader.next()) {
    }
  }
}

}  // namespace
}  // namespace ur_ros_rtde
