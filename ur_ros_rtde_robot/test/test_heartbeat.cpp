#include <gtest/gtest.h>
#include <ur_rtde/rtde_control_interface.h>

#include "support.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST(HeartbeatTest, IsNotMissedWhileTheProgramIsPaused)
{
  Controller controller(Controller::options());
  ur_rtde::RTDEControlInterface control(own_address(), -1.0, ur_rtde::RTDEControlInterface::FLAGS_DEFAULT,
                                        50002, -1);
  const auto time = [&] { return controller.state().at("timestamp").get<double>(); };
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "PAUSED"; }));
  const double paused = time();
  ASSERT_TRUE(eventually([&] { return time() > paused + 0.2; }));
  ASSERT_TRUE(control.isConnected());
  EXPECT_LT(control.getTimeSinceHeartbeat(), 50ms);
}

}  // namespace
}  // namespace ur_ros_rtde::test
