#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "diagnostics/package_statistics.hpp"
#include "recording/csv_file.hpp"
#include "recording/row_queue.hpp"
#include "recording/stop_recorder.hpp"

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

TEST(PackageStatisticsTest, CountTheRateFromTheConnectionOn)
{
  PackageStatistics statistics;
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  const auto begin = std::chrono::steady_clock::now() - std::chrono::milliseconds(100);
  for (int i = 0; i <= 50; ++i) {
    statistics.add(sample(0.002 * i, begin + std::chrono::milliseconds(2 * i)), 500.0);
  }
  EXPECT_GT(statistics.report().rate, 100.0) << "83 since the statistics exist";
}

struct StopRecorderTest : CsvFileTest {
  static constexpr double cycle = 0.002;  // s

  std::filesystem::path records = std::filesystem::path(folder) / "log";
  std::mutex mutex;
  std::condition_variable logged;
  std::vector<std::string> log;
  StopRecorder recorder{records, "127.0.0.9", [this](LogLevel, const std::string & message) {
                          const std::lock_guard lock(mutex);
                          log.push_back(message);
                          logged.notify_all();
                        }};
  double time = 100.0;

  void run(double duration, SafetyMode mode, std::uint32_t link = 1)
  {
    for (const double end = time + duration - 0.5 * cycle; time < end; time += cycle) {
      Sample sample{};
      sample.link = link;
      sample.controller_time = time;
      sample.safety_mode = mode;
      sample.actual_qd[1] = mode == SafetyMode::normal ? 0.5 : 0.0;
      recorder.add(sample);
    }
  }

  std::string message(std::size_t index)
  {
    std::unique_lock lock(mutex);
    return logged.wait_for(lock, std::chrono::seconds(20), [&] { return log.size() > index; }) ? log[index]
                                                                                               : "";
  }

  std::vector<std::filesystem::path> files() const
  {
    if (!std::filesystem::exists(records)) {
      return {};
    }
    return {std::filesystem::directory_iterator(records), std::filesystem::directory_iterator()};
  }

  /// The values of a column.
  static std::vector<double> column(const std::filesystem::path & path, const std::string & name)
  {
    std::istringstream lines(text(path.string()));
    std::string line;
    std::getline(lines, line);
    std::istringstream header(line);
    std::size_t index = 0;
    for (std::string title; std::getline(header, title, ',') && title != name;) {
      ++index;
    }
    std::vector<double> values;
    while (std::getline(lines, line)) {
      std::istringstream row(line);
      std::string number;
      for (std::size_t i = 0; i <= index; ++i) {
        std::getline(row, number, ',');
      }
      values.push_back(std::stod(number));
    }
    return values;
  }
};

TEST_F(StopRecorderTest, WritesTheTimeAroundAProtectiveStop)
{
  run(5.0, SafetyMode::normal);
  const double stop = time;
  run(0.5, SafetyMode::protective_stop);
  EXPECT_NE(message(0).find("PROTECTIVE_STOP"), std::string::npos) << message(0);
  ASSERT_EQ(files().size(), 1U);
  const auto file = files().front();
  EXPECT_NE(message(0).find(file.string()), std::string::npos);
  EXPECT_TRUE(file.filename().string().ends_with("_127.0.0.9_PROTECTIVE_STOP.csv")) << file;
  const auto times = column(file, "timestamp");
  EXPECT_NEAR(times.front(), stop - StopRecorder::time_before, 2.0 * cycle);
  EXPECT_NEAR(times.back(), stop + StopRecorder::time_after, 2.0 * cycle);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  const auto speeds = column(file, "actual_qd_1");
  EXPECT_EQ(speeds.front(), 0.5);
  EXPECT_EQ(speeds.back(), 0.0);
  EXPECT_EQ(column(file, "safety_mode").back(), 3.0);
}

TEST_F(StopRecorderTest, WritesOnlyWhatItHasSeen)
{
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::fault);
  EXPECT_NE(message(0).find("FAULT"), std::string::npos) << message(0);
  const auto times = column(files().front(), "timestamp");
  EXPECT_EQ(times.front(), 100.0);
}

TEST_F(StopRecorderTest, IgnoresAStopThatLastedAtTheStartOfTheConnectionAndStopsByPeople)
{
  run(0.5, SafetyMode::protective_stop);
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::safeguard_stop);
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::protective_stop, 2);
  run(0.5, SafetyMode::normal, 2);
  run(0.5, SafetyMode::violation, 2);
  EXPECT_NE(message(0).find("VIOLATION"), std::string::npos) << message(0);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(StopRecorderTest, KeepsTheNewestFiles)
{
  std::filesystem::create_directories(records);
  for (std::size_t i = 0; i < StopRecorder::max_files; ++i) {
    std::ofstream(records / ("ur_stop_20200101-0000" + std::to_string(10 + i) + "_127.0.0.9_FAULT.csv"));
  }
  std::ofstream(records / "other.csv");
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::protective_stop);
  EXPECT_NE(message(0), "");
  EXPECT_EQ(files().size(), StopRecorder::max_files + 1);
  EXPECT_FALSE(std::filesystem::exists(records / "ur_stop_20200101-000010_127.0.0.9_FAULT.csv"));
  EXPECT_TRUE(std::filesystem::exists(records / "other.csv"));
}

TEST_F(StopRecorderTest, WritesAStopWhoseConnectionBreaks)
{
  run(1.0, SafetyMode::normal);
  run(0.1, SafetyMode::protective_stop);
  const double broken = time;
  run(0.5, SafetyMode::protective_stop, 2);
  EXPECT_NE(message(0), "");
  ASSERT_EQ(files().size(), 1U);
  const auto times = column(files()[0], "timestamp");
  EXPECT_NEAR(times.back(), broken, 2.0 * cycle);
}

TEST_F(StopRecorderTest, KeepsItsFileIfOthersAreOfTheFuture)
{
  std::filesystem::create_directories(records);
  for (std::size_t i = 0; i < StopRecorder::max_files; ++i) {
    std::ofstream(records / ("ur_stop_20990101-0000" + std::to_string(10 + i) + "_127.0.0.9_FAULT.csv"));
  }
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::protective_stop);
  EXPECT_NE(message(0), "");
  EXPECT_EQ(files().size(), StopRecorder::max_files);
  EXPECT_FALSE(std::filesystem::exists(records / "ur_stop_20990101-000010_127.0.0.9_FAULT.csv"));
}

TEST(LogFolderTest, IsAbsolute)
{
  const char * const before = std::getenv("ROS_LOG_DIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("ROS_LOG_DIR", "log", 1);
  EXPECT_EQ(log_folder(), std::filesystem::current_path() / "log");
  before == nullptr ? ::unsetenv("ROS_LOG_DIR") : ::setenv("ROS_LOG_DIR", kept.c_str(), 1);
}

TEST_F(StopRecorderTest, ReportsAFolderThatCannotBeWritten)
{
  std::ofstream(records.string()) << "a file";
  run(0.5, SafetyMode::normal);
  run(0.5, SafetyMode::protective_stop);
  EXPECT_NE(message(0).find("cannot be created"), std::string::npos) << message(0);
}

}  // namespace
}  // namespace ur_ros_rtde
