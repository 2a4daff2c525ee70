#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <action_msgs/msg/goal_status_array.hpp>
#include <cstdio>

#include "motion_test.hpp"

using action_msgs::msg::GoalStatus;

namespace {

/// Runs the program moving_client. The arm moves when the constructor returns.
class MovingClient {
 public:
  MovingClient()
  {
    int output[2];
    if (::pipe(output) != 0) {
      throw std::runtime_error("no pipe");
    }
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(output[1], STDOUT_FILENO);
      ::close(output[0]);
      ::execl(MOVING_CLIENT, MOVING_CLIENT, nullptr);
      ::_exit(127);
    }
    ::close(output[1]);
    char letter = 0;
    moving_ = ::read(output[0], &letter, 1) == 1;
    ::close(output[0]);
  }
  ~MovingClient() { end(SIGKILL); }

  bool moving() const { return moving_; }
  void end(int signal)
  {
    if (process_ > 0) {
      ::kill(process_, signal);
      ::waitpid(process_, nullptr, 0);
      process_ = -1;
    }
  }

 private:
  pid_t process_ = -1;
  bool moving_ = false;
};

class LostClientCheck : public MotionTest {
 protected:
  int newest_status()
  {
    const auto status = statuses.newest();
    return status && !status->status_list.empty() ? status->status_list.back().status
                                                  : GoalStatus::STATUS_UNKNOWN;
  }

  /// Returns the time from the end of the client to standstill, s.
  double time_to_standstill(int signal)
  {
    MovingClient client;
    EXPECT_TRUE(client.moving());
    EXPECT_TRUE(eventually([&] { return arm.speed() > 0.05; }));
    const auto begin = std::chrono::steady_clock::now();
    client.end(signal);
    EXPECT_TRUE(eventually([&] { return arm.at_rest(); }, motion_limit))
        << "the arm continues to move without its client";
    const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    RecordProperty("standstill_after_s", std::to_string(time));
    std::printf("standstill %.2f s after signal %d\n", time, signal);
    EXPECT_FALSE(arm.at({3.0, -1.57, 1.57, -1.57, -1.57, 0.0})) << "the goal was completed";
    EXPECT_TRUE(eventually([&] { return newest_status() == GoalStatus::STATUS_ABORTED; }));
    return time;
  }

  MessageCollector<action_msgs::msg::GoalStatusArray> statuses{*node, "move_j/_action/status",
                                                               rclcpp::QoS(1).transient_local()};
};

TEST_F(LostClientCheck, TerminatedClientLeavesTheArmAtRest)
{
  EXPECT_LT(time_to_standstill(SIGTERM), 2.0);
}

TEST_F(LostClientCheck, InterruptedClientLeavesTheArmAtRest)
{
  EXPECT_LT(time_to_standstill(SIGINT), 2.0);
}

TEST_F(LostClientCheck, KilledClientLeavesTheArmAtRest)
{
  EXPECT_LT(time_to_standstill(SIGKILL), 25.0);  // the lease of the client's participant, 20 s by default
}

}  // namespace
