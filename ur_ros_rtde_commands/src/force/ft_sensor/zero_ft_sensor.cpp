#include <ur_ros_rtde_msgs/action/zero_ft_sensor.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double zero_tolerance = 5.0;  // N, above the noise of the sensors
}

class ZeroFtSensor : public Command<ur_ros_rtde_msgs::action::ZeroFtSensor> {
  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  /// A CB3 has no sensor to be zeroed (UR's client library, zeroFTSensor).
  void check(const Goal &, Check & check) const override { check.polyscope(0); }

  Outcome run(const Goal &, Run & run) override
  {
    check_result(run.control()->zeroFtSensor(), "zero the sensor");
    const auto newest = run.state().sequence;  // may be older than the command
    const auto reads_zero = [&] {
      return run.state().sequence > newest + 1 && length(position(run.flange_force())) < zero_tolerance;
    };
    const Outcome outcome =
        run.expect(reads_zero, std::chrono::seconds(1), "the sensor does not read zero afterwards");
    const Vector6 f = run.flange_force();
    auto & wrench = run.result().wrench;
    wrench.force.x = f[0];
    wrench.force.y = f[1];
    wrench.force.z = f[2];
    wrench.torque.x = f[3];
    wrench.torque.y = f[4];
    wrench.torque.z = f[5];
    return outcome;
  }
};

UR_ROS_RTDE_EXPORT(ZeroFtSensor, "zero_ft_sensor")

}  // namespace ur_ros_rtde
