// ur_rtde, with its patch "Do not wait for a script that has ended to become ready".
#include <gtest/gtest.h>
#include <ur_rtde/rtde_control_interface.h>

#include <chrono>
#include <future>

#include "support.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST(EndedScriptTest, EndsTheWaitOfACommandForItsReadiness)
{
  Controller controller(Controller::options());
  ur_rtde::RTDEControlInterface control(own_address());
  control.setCommandTimeout(50ms);
  EXPECT_FALSE(control.moveJ({0.0, -1.57, 1.57, -1.57, -1.57, 1.0}, 0.1, 0.1)) << "takes longer than 50 ms";
  control.setCommandTimeout(20s);
  control.setReadyTimeout(20s);
  auto stopped = std::async(std::launch::async, [&] { return control.stopScript(); });
  EXPECT_EQ(stopped.wait_for(200ms), std::future_status::timeout) << "the script executes the motion";
  controller.control({{"command", "kill_program"}});
  ASSERT_EQ(stopped.wait_for(10s), std::future_status::ready);
  EXPECT_FALSE(stopped.get()) << "something else has ended the script";
}

}  // namespace
}  // namespace ur_ros_rtde::test
