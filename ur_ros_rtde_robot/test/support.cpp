#include "support.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>

namespace ur_ros_rtde::test {

std::string own_address()
{
  const auto * info = testing::UnitTest::GetInstance()->current_test_info();
  // Tells apart the runs of a test that is repeated.
  const char * reserved = std::getenv("UR_TEST_ADDRESS");
  const auto hash = std::hash<std::string>{}(std::string(info->test_suite_name()) + info->name() +
                                             (reserved != nullptr ? reserved : ""));
  // Not 127.0.x.y, which is common for servers that are started manually.
  return "127." + std::to_string(16 + hash % 200) + "." + std::to_string(hash / 200 % 250) + "." +
         std::to_string(2 + hash / 50000 % 250);
}

std::uint16_t free_port()
{
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ::bind(descriptor, reinterpret_cast<const sockaddr *>(&address), sizeof(address));
  socklen_t size = sizeof(address);
  ::getsockname(descriptor, reinterpret_cast<sockaddr *>(&address), &size);
  ::close(descriptor);
  return ntohs(address.sin_port);
}

bool eventually(const std::function<bool()> & condition, std::chrono::milliseconds timeout)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

ur_simulator::SimulatorOptions Controller::options()
{
  ur_simulator::SimulatorOptions result;
  result.address = own_address();
  if (const char * factor = std::getenv("UR_TEST_REAL_TIME_FACTOR")) {
    result.real_time_factor = std::strtod(factor, nullptr);
  }
  return result;
}

ur_simulator::SimulatorOptions Controller::slow_options()
{
  auto result = options();
  result.real_time_factor /= 10.0;
  return result;
}

void Controller::start(const ur_simulator::SimulatorOptions & options)
{
  controller_ = std::make_unique<ur_simulator::SimulatedController>(options);
}

nlohmann::json Controller::control(const nlohmann::json & request)
{
  const auto reply = controller_->control(request);
  EXPECT_TRUE(reply.at("ok").get<bool>()) << request << " -> " << reply;
  return reply;
}

void Controller::run_other_program()
{
  control({{"command", "run_script"}, {"script", "def other():\n  while True:\n    sync()\n  end\nend\n"}});
}

LogFunction Log::function()
{
  return [this](LogLevel level, const std::string & line) {
    static constexpr std::array<const char *, 4> levels{"[debug] ", "[info] ", "[warn] ", "[error] "};
    const std::lock_guard lock(mutex_);
    lines_.push_back(levels.at(static_cast<std::size_t>(level)) + line);
  };
}

std::size_t Log::count(const std::string & part) const
{
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::count_if(lines_.begin(), lines_.end(), [&](const std::string & line) {
    return line.find(part) != std::string::npos;
  }));
}

std::string Log::text() const
{
  const std::lock_guard lock(mutex_);
  std::string all;
  for (const auto & line : lines_) {
    all += line + "\n";
  }
  return all;
}

OtherService::OtherService(std::uint16_t port, std::string reply, bool listens_first)
    : reply_(std::move(reply))
{
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, own_address().c_str(), &address.sin_addr);
  if (::bind(listener_, reinterpret_cast<const sockaddr *>(&address), sizeof(address)) != 0 ||
      ::listen(listener_, 8) != 0) {
    ADD_FAILURE() << "cannot listen on port " << port;
  }
  thread_ = std::jthread([this, listens_first](const std::stop_token & stop) {
    std::vector<int> clients;
    while (!stop.stop_requested()) {
      pollfd entry{listener_, POLLIN, 0};
      if (::poll(&entry, 1, 10) > 0) {
        const int client = ::accept(listener_, nullptr, nullptr);
        pollfd line{client, POLLIN, 0};
        if (listens_first && ::poll(&line, 1, 5000) <= 0) {
          ADD_FAILURE() << "nothing was sent to the service";
        }
        ::send(client, reply_.data(), reply_.size(), MSG_NOSIGNAL);
        clients.push_back(client);
      }
    }
    std::for_each(clients.begin(), clients.end(), ::close);
  });
}

OtherService::~OtherService()
{
  thread_.request_stop();
  thread_.join();
  ::close(listener_);
}

namespace {

std::size_t entries(const char * folder)
{
  const std::filesystem::directory_iterator all(folder);
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

}  // namespace

std::size_t open_descriptors()
{
  return entries("/proc/self/fd");
}

std::size_t running_threads()
{
  return entries("/proc/self/task");
}

RobotOptions robot_options()
{
  RobotOptions result;
  result.address = own_address();
  result.silence_limit = 1000ms;
  result.watchdog_frequency = 1.0;
  return result;
}

StateReceiverOptions receiver_options()
{
  StateReceiverOptions result;
  result.address = own_address();
  result.silence_limit = 1000ms;
  return result;
}

}  // namespace ur_ros_rtde::test
