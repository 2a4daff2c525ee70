// The ur_rtde library as a client of a simulator with PolyScope X.
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include <cmath>

#include "support/polyscope_x_test.hpp"

namespace ur_simulator::testing {
namespace {

// ur_rtde uploads its script from 10.10 on, and does not use a dashboard server.
TEST(UrRtdePolyscopeXTest, UploadsControlScriptAndMoves)
{
  for (const char * version : {"10.10.0", "10.12.1", "10.14.0"}) {
    SimulatedController controller(polyscope_x_options(version));
    ur_rtde::RTDEReceiveInterface receive(controller.address());
    ur_rtde::RTDEControlInterface control(controller.address(), -1.0,
                                          ur_rtde::RTDEControlInterface::FLAGS_DEFAULT, 50002, -1);
    EXPECT_TRUE(control.isProgramRunning()) << version;
    std::vector<double> target = receive.getActualQ();
    target[0] += 0.1;
    EXPECT_TRUE(control.moveJ(target, 2.0, 4.0)) << version;
    const json position = controller.state()["actual"]["position"];
    EXPECT_NEAR(position[0].get<double>(), target[0], 1e-3) << version;
  }
}

}  // namespace
}  // namespace ur_simulator::testing
