#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// A process with a driver that moves the arm until it is killed. Construct it before the test starts a
/// thread.
class DriverProcess {
 public:
  DriverProcess()
  {
    process_ = ::fork();
    if (process_ == 0) {
      move_forever();
    }
  }
  ~DriverProcess()
  {
    send(SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  void send(int signal) const { ::kill(process_, signal); }

 private:
  [[noreturn]] static void move_forever()
  {
    auto options = robot_options();
    options.watchdog_frequency = RobotOptions().watchdog_frequency;
    Robot robot(options);
    robot.start();
    if (robot.wait_until_ready(30s)) {
      const auto lease = robot.acquire({.resource = Resource::motion, .owner = "/test", .id = "1"});
      robot.control(*lease)->speedJ({0.5, 0.0, 0.0, 0.0, 0.0, 0.0}, 2.0, 0.0);
      std::this_thread::sleep_for(60s);
    }
    ::_exit(1);
  }
  pid_t process_ = -1;
};

double base_speed(Controller & controller)
{
  return std::abs(controller.state().at("actual").at("velocity").at(0).get<double>());
}

/// Simulator time until the target of the arm is at rest, in s.
double time_to_rest(Controller & controller)
{
  const auto begin = controller.state().at("cycle").get<std::uint64_t>();
  EXPECT_TRUE(eventually([&] { return base_speed(controller) < 0.01; }));
  const auto trace = controller.control({{"command", "trace"}, {"after", begin}});
  for (const auto & entry : trace.at("cycles")) {
    if (entry.at(2).get<double>() < 0.01) {  // target speed of the fastest joint
      return 0.002 * static_cast<double>(entry.at(0).get<std::uint64_t>() - begin);
    }
  }
  ADD_FAILURE() << "the target is not at rest";
  return 0.0;
}

bool program_stops(Controller & controller)
{
  return eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; });
}

TEST(WatchdogTest, StopsTheArmWhenTheDriverIsKilled)
{
  const DriverProcess driver;
  Controller controller(Controller::slow_options());
  ASSERT_TRUE(eventually([&] { return base_speed(controller) > 0.45; }, 30s));
  driver.send(SIGKILL);
  const double time = time_to_rest(controller);
  RecordProperty("standstill_after_ms", std::to_string(1000.0 * time));
  EXPECT_LT(time, 0.3);
  EXPECT_TRUE(program_stops(controller));
}

TEST(WatchdogTest, StopsTheArmWhenTheDriverHangs)
{
  const DriverProcess driver;
  Controller controller(Controller::slow_options());
  ASSERT_TRUE(eventually([&] { return base_speed(controller) > 0.45; }, 30s));
  driver.send(SIGSTOP);  // all its connections stay open
  EXPECT_LT(time_to_rest(controller), 0.4);
  EXPECT_TRUE(program_stops(controller));
}

TEST(WatchdogTest, LetsALiveDriverContinue)
{
  const DriverProcess driver;
  Controller controller(Controller::slow_options());
  ASSERT_TRUE(eventually([&] { return base_speed(controller) > 0.45; }, 30s));
  const double begin = controller.state().at("timestamp").get<double>();
  const double end = begin + 5.0 / RobotOptions().watchdog_frequency;
  EXPECT_TRUE(eventually([&] { return controller.state().at("timestamp").get<double>() > end; }));
  EXPECT_GT(base_speed(controller), 0.45);
}

}  // namespace
}  // namespace ur_ros_rtde::test
