#include "app/status_display.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace ur_simulator {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds update_period{200};
constexpr std::chrono::seconds answer_timeout{1};

bool standard_output_is_terminal()
{
  const char * type = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) != 0 && type != nullptr && std::string_view(type) != "dumb";
}

std::string last_error_of(const EventLog & log)
{
  const auto & entries = log.entries();
  const auto last = std::find_if(entries.rbegin(), entries.rend(),
                                 [](const LogEntry & entry) { return entry.level == LogLevel::error; });
  return last == entries.rend() ? ""
                                : fmt::format("[{:.3f}] {}: {}", last->timestamp, last->source, last->text);
}

void print(const std::string & text)
{
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

StatusDisplay::StatusDisplay(const std::vector<Robot> & robots) : terminal_(standard_output_is_terminal())
{
  for (const Robot & robot : robots) {
    robots_.push_back({robot.controller, {robot.address, nullptr, "", 0.0}, Clock::now(), 0.0, ""});
  }
  thread_ = std::thread([this] { run(); });
}

StatusDisplay::~StatusDisplay()
{
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void StatusDisplay::run()
{
  do {
    std::ranges::for_each(robots_, update);
    terminal_ ? redraw() : print_changes();
  } while (wait());
}

bool StatusDisplay::wait()
{
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, update_period, [this] { return closing_; });
}

void StatusDisplay::update(Shown & robot)
{
  auto answer = robot.controller->call([controller = robot.controller] {
    return std::pair(controller->state(), last_error_of(controller->log()));
  });
  if (answer.wait_for(answer_timeout) != std::future_status::ready) {
    return;
  }
  auto [state, last_error] = answer.get();
  const Clock::time_point now = Clock::now();
  const double time = state.at("timestamp");
  // 0 after a restart of the robot, which sets its clock back.
  const double simulated = std::max(0.0, time - std::exchange(robot.simulated_time, time));
  robot.status.real_time_factor =
      simulated / std::chrono::duration<double>(now - std::exchange(robot.time, now)).count();
  robot.status.state = std::move(state);
  robot.status.last_error = std::move(last_error);
}

void StatusDisplay::print_changes()
{
  for (Shown & robot : robots_) {
    if (robot.status.state.is_null()) {
      continue;
    }
    std::string description = describe_state(robot.status);
    if (description != robot.description) {
      print(fmt::format("[{:.3f}] {}: {}\n", robot.status.state.at("timestamp").get<double>(),
                        robot.status.address, description));
      robot.description = std::move(description);
    }
  }
}

void StatusDisplay::redraw()
{
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row < 3) {
    size.ws_col = 80;
    size.ws_row = 24;
  }
  std::vector<RobotStatus> known;
  for (const Shown & robot : robots_) {
    if (!robot.status.state.is_null()) {
      known.push_back(robot.status);
    }
  }
  // The cursor is below the lines.
  std::string text = drawn_lines_ == 0 ? "" : fmt::format("\x1b[{}A", drawn_lines_);
  const std::vector<std::string> lines = status_lines(known, size.ws_col - 1U, size.ws_row - 1U);
  for (const std::string & line : lines) {
    text += fmt::format("\r{}\x1b[K\n", line);
  }
  print(text + "\x1b[J");
  drawn_lines_ = lines.size();
}

}  // namespace ur_simulator
