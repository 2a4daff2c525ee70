#include "input.hpp"
#include "state/description_kinematics.hpp"

// The URDF of the topic robot_description, which the driver compares with the arm.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size)
{
  using namespace ur_ros_rtde;
  static const kinematics::DhRows arm = kinematics::dh_rows(
      {.d1 = 0.1625, .a2 = -0.425, .a3 = -0.3922, .d4 = 0.1333, .d5 = 0.0997, .d6 = 0.0996});
  const std::string urdf(ur_fuzz::Input(data, size).take_piece(0));
  if (const auto origins = read_description(urdf, "")) {
    (void)compare_kinematics(*origins, arm).is_negligible();
  }
  return 0;
}
