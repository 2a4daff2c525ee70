#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "diagnostics/package_statistics.hpp"
#include "recording/csv_file.hpp"
#include "recording/row_queue.hpp"

namespace ur_ros_rtde {
namespace {

struct CsvFileTest : testing::Test {
  std::string folder = (std::filesystem::temp_directory_path() / "csv_file_XXXXXX").string();

  CsvFileTest() { EXPECT_NE(::mkdtemp(folder.data()), nullptr); }
  ~CsvFileTest() override { std::filesystem::remove_all(folder); }

  static std::string text(const std::string & path)
  {
    std::ostringstream all;
    all << std::ifstream(path).rdbuf();
    return all.str();
  }
};

TEST_F(CsvFileTest, HasAHeaderAndRows)
{
  const std::string path = folder + "/run.csv";
  auto file = CsvFile::create(path, {"timestamp", "robot_mode"});
  ASSERT_TRUE(file) << file.error().message;
  file->append(std::array{0.5, 7.0});
  file->append(std::array{-1e-300, -1.0});
  EXPECT_EQ(file->rows(), 0U) << "nothing has been written yet";
  ASSERT_TRUE(file->close());
  EXPECT_EQ(file->rows(), 2U);
  EXPECT_EQ(text(path), "timestamp,robot_mode\n0.5,7\n-1e-300,-1\n");
}

TEST_F(CsvFileTest, HasFullRoundTripPrecision)
{
  const std::array numbers{0.1 + 0.2,
                           1.0 / 3.0,
                           std::numeric_limits<double>::denorm_min(),
                           std::numeric_limits<double>::max(),
                           -0.0,
                           9007199254740993.0};
  const std::string path = folder + "/numbers.csv";
  auto file = CsvFile::create(path, {"a", "b", "c", "d", "e", "f"});
  file->append(numbers);
  ASSERT_TRUE(file->close());
  std::istringstream lines(text(path));
  std::string number;
  std::getline(lines, number);
  for (const double wanted : numbers) {
    std::getline(lines, number, &wanted == &numbers.back() ? '\n' : ',');
    const double read = std::strtod(number.c_str(), nullptr);
    EXPECT_EQ(read, wanted);
    EXPECT_EQ(std::signbit(read), std::signbit(wanted));
  }
}

TEST_F(CsvFileTest, RequiresANewFileWithAnAbsolutePath)
{
  const std::string path = folder + "/run.csv";
  ASSERT_TRUE(CsvFile::create(path, {"a"}));
  for (const std::string & wrong : {path, std::string("run.csv"), std::string(), folder + "/none/run.csv"}) {
    const auto file = CsvFile::create(wrong, {"a"});
    ASSERT_FALSE(file) << wrong;
    EXPECT_EQ(file.error().code, ErrorCode::invalid_goal);
  }
}

TEST(RowQueueTest, KeepsTheOrderAndRejectsRowsWhenFull)
{
  RowQueue queue(2, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(queue.push(std::array{1.0 * i, 10.0 * i}));
  }
  EXPECT_FALSE(queue.push(std::array{3.0, 30.0}));
  std::vector<double> rows;
  ASSERT_TRUE(queue.take(rows));
  EXPECT_EQ(rows, (std::vector{0.0, 0.0, 1.0, 10.0, 2.0, 20.0}));
  EXPECT_TRUE(queue.push(std::array{3.0, 30.0}));
  queue.close();
  ASSERT_TRUE(queue.take(rows));
  EXPECT_EQ(rows.size(), 2U);
  EXPECT_FALSE(queue.take(rows));
}

TEST(RowQueueTest, CloseWakesTheWaitingThread)
{
  RowQueue queue(1, 1);
  std::jthread closer([&] { queue.close(); });
  std::vector<double> rows;
  EXPECT_FALSE(queue.take(rows));
}

Sample sample(double controller_time, std::chrono::steady_clock::time_point received)
{
  Sample made{};
  made.link = 1;
  made.controller_time = controller_time;
  made.received = received;
  return made;
}

TEST(PackageStatisticsTest, ReportIntervalsAndMissingCycles)
{
  PackageStatistics statistics;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) {
    const int cycle = i < 150 ? i : i + 3;  // three are missing
    statistics.add(sample(0.002 * cycle, begin + std::chrono::milliseconds(2 * cycle)), 500.0);
  }
  const auto report = statistics.report();
  EXPECT_EQ(report.received_total, 200U);
  EXPECT_EQ(report.lost, 3U);
  EXPECT_NEAR(report.mean_interval, 2e-3 * 202 / 199, 1e-9);
  EXPECT_NEAR(report.p99_interval, 2e-3, 1e-9);
  EXPECT_NEAR(report.longest, 8e-3, 1e-9);
  EXPECT_EQ(statistics.report().lost, 0U);
  EXPECT_EQ(statistics.report().lost_total, 3U);
}

TEST(PackageStatisticsTest, RestartWithANewConnection)
{
  PackageStatistics statistics;
  const auto begin = std::chrono::steady_clock::now();
  statistics.add(sample(100.0, begin), 500.0);
  Sample again = sample(0.0, begin + std::chrono::seconds(5));
  again.link = 2;
  statistics.add(again, 500.0);
  const auto report = statistics.report();
  EXPECT_EQ(report.lost_total, 0U);
  EXPECT_EQ(report.longest, 0.0);
}

}  // namespace
}  // namespace ur_ros_rtde
