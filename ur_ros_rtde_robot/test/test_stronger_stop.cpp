// Requests that make a stop stronger while it ends the program of an arm that is at rest.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <map>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// Takes the place of the dashboard server for new connections, and answers `stop` when the test says so.
class HeldDashboard {
 public:
  HeldDashboard()
  {
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(29999);
    ::inet_pton(AF_INET, own_address().c_str(), &address.sin_addr);
    if (::bind(listener_, reinterpret_cast<const sockaddr *>(&address), sizeof(address)) != 0 ||
        ::listen(listener_, 8) != 0) {
      ADD_FAILURE() << "cannot listen on the port of the dashboard server";
    }
    thread_ = std::jthread([this](const std::stop_token & stop) { serve(stop); });
  }
  ~HeldDashboard()
  {
    thread_.request_stop();
    thread_.join();
    ::close(listener_);
  }
  HeldDashboard(const HeldDashboard &) = delete;
  HeldDashboard & operator=(const HeldDashboard &) = delete;

  /// Number of requests to stop the program.
  int stops() const
  {
    const std::lock_guard lock(mutex_);
    return stops_;
  }
  /// Answers those that wait; `and_later`: also those that follow.
  void answer(const std::string & reply, bool and_later = false)
  {
    const std::lock_guard lock(mutex_);
    for (const int client : waiting_) {
      send(client, reply);
    }
    waiting_.clear();
    later_reply_ = and_later ? reply : "";
  }

 private:
  static void send(int client, const std::string & line)
  {
    const std::string bytes = line + "\n";
    (void)::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  void serve(const std::stop_token & stop)
  {
    while (!stop.stop_requested()) {
      std::vector<pollfd> entries{{listener_, POLLIN, 0}};
      for (const auto & [client, received] : received_) {
        entries.push_back({client, POLLIN, 0});
      }
      if (::poll(entries.data(), entries.size(), 10) <= 0) {
        continue;
      }
      for (const pollfd & entry : entries) {
        if (entry.revents != 0 && entry.fd == listener_) {
          accept();
        } else if (entry.revents != 0) {
          read(entry.fd);
        }
      }
    }
    for (const auto & [client, received] : received_) {
      ::close(client);
    }
  }

  void accept()
  {
    if (const int client = ::accept(listener_, nullptr, nullptr); client >= 0) {
      received_[client];
      send(client, "Connected: Universal Robots Dashboard Server");
    }
  }

  void read(int client)
  {
    std::array<char, 256> bytes;
    const auto size = ::recv(client, bytes.data(), bytes.size(), 0);
    if (size <= 0) {
      const std::lock_guard lock(mutex_);
      std::erase(waiting_, client);
      received_.erase(client);
      ::close(client);
      return;
    }
    std::string & received = received_[client];
    received.append(bytes.data(), static_cast<std::size_t>(size));
    for (auto end = received.find('\n'); end != std::string::npos; end = received.find('\n')) {
      process(client, received.substr(0, end));
      received.erase(0, end + 1);
    }
  }

  void process(int client, const std::string & line)
  {
    const std::lock_guard lock(mutex_);
    if (line != "stop") {
      send(client, "could not understand: '" + line + "'");
      return;
    }
    ++stops_;
    if (later_reply_.empty()) {
      waiting_.push_back(client);
    } else {
      send(client, later_reply_);
    }
  }

  const int listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  std::map<int, std::string> received_;  ///< by client; server's thread only
  mutable std::mutex mutex_;
  int stops_ = 0;
  std::vector<int> waiting_;  ///< clients
  std::string later_reply_;
  std::jthread thread_;
};

/// The arm is at rest because of a safeguard stop. The robot has only paused the program, and would resume
/// it.
struct StrongerStopTest : RobotFixture {
  void SetUp() override
  {
    auto options = robot_options();
    options.watchdog_frequency = 0.0;  // only the dashboard server can end the program
    options.retry_interval = 5s;       // the driver itself also asks for the end of a paused program
    make_both(options);
    move_joints();
    controller.control({{"command", "remote_control"}, {"on", false}});  // so that it is rejected
    controller.control({{"command", "safeguard"}});
    ASSERT_TRUE(eventually([&] { return at_rest() && !robot->latest()->is_program_running(); }));
    ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::safeguard_stop));
    controller.control({{"command", "refuse_connections"}, {"which", "dashboard"}});
  }
  std::string program() { return controller.state().at("program").at("state").get<std::string>(); }
};

TEST_F(StrongerStopTest, EndsWithAResultAndTheArmStaysAtRest)
{
  ASSERT_TRUE(eventually([&] { return program() == "PAUSED"; })) << program();
  HeldDashboard dashboard;
  std::vector<std::shared_future<Expected<StopReport>>> stops{robot->begin_stop({}, stopped_by_the_driver())};
  constexpr int rounds = 4;  // more than a stop may fail
  for (int round = 1; round <= rounds; ++round) {
    ASSERT_TRUE(eventually([&] { return dashboard.stops() >= round; })) << "the stop was given up";
    StopOptions stronger;
    stronger.joint_deceleration = 2.0 + round;
    stops.push_back(robot->begin_stop(stronger, stopped_by_the_driver()));
    EXPECT_NE(stops.front().wait_for(0s), std::future_status::ready) << "round " << round;
    dashboard.answer("Failed to execute: stop");
  }
  ASSERT_TRUE(eventually([&] { return dashboard.stops() > rounds; })) << "the stop was given up";
  controller.control({{"command", "stop_program"}});
  dashboard.answer("Stopped", true);
  for (const auto & stop : stops) {
    ASSERT_EQ(stop.wait_for(20s), std::future_status::ready);
    EXPECT_TRUE(stop.get()) << stop.get().error().message;
  }
  EXPECT_FALSE(robot->is_stopping());
  EXPECT_EQ(program(), "STOPPED");
  const double position = robot->latest()->actual_q[0];
  controller.control({{"command", "safeguard"}, {"open", false}});
  const double end = robot->latest()->controller_time + 0.5;
  EXPECT_TRUE(eventually([&] { return robot->latest()->controller_time > end; }));
  EXPECT_NEAR(robot->latest()->actual_q[0], position, 1e-3) << "the motion was resumed";
}

}  // namespace
}  // namespace ur_ros_rtde::test
