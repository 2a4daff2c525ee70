#include <cmath>
#include <numbers>
#include <ur_ros_rtde/extension.hpp>
#include <ur_ros_rtde_tutorials/action/spiral_search.hpp>

namespace ur_ros_rtde_tutorials {

class SpiralSearch : public ur_ros_rtde::Extension<action::SpiralSearch> {
  // Runs on the controller. The angle grows in each control cycle by the distance along the spiral. The speed
  // increases linearly in the first second.
  ur_ros_rtde::ScriptExtension script() const override
  {
    return {.snippet = R"(
      radius = $in19f
      pitch = $in20f / 6.283185307179586
      speed = $in21f
      force = $in22f
      start = get_target_tcp_pose()
      initial_force = get_tcp_force()
      cycle = get_steptime()
      angle = 0.0
      time = 0.0
      contact_force = 0.0
      while pitch * angle < radius and contact_force < force:
        time = time + cycle
        if time < 1.0:
          distance = speed * time * cycle
        else:
          distance = speed * cycle
        end
        angle = angle + distance / (pitch * sqrt(1 + angle * angle))
        offset = p[pitch * angle * cos(angle), pitch * angle * sin(angle), 0, 0, 0, 0]
        servoj(get_inverse_kin(pose_trans(start, offset)), 0, 0, cycle, 0.05, 300)
        now = get_tcp_force()
        contact_force = norm([now[0] - initial_force[0], now[1] - initial_force[1], now[2] - initial_force[2]])
      end
      stopj(2)
      if contact_force >= force:
        $out19i(1)
      else:
        $out19i(0)
      end
      $out19f(pitch * angle)
    )"};
  }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override
  {
    check.in_range("radius", goal.radius, 0.001, 0.1, "m")
        .in_range("pitch", goal.pitch, 0.0005, 0.02, "m")
        .in_range("speed", goal.speed, 0.001, 0.05, "m/s")
        .in_range("force", goal.force, 1.0, 100.0, "N");
  }

  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    run.registers().set_double(19, goal.radius);
    run.registers().set_double(20, goal.pitch);
    run.registers().set_double(21, goal.speed);
    run.registers().set_double(22, goal.force);
    const double length = std::numbers::pi * goal.radius * goal.radius / goal.pitch + goal.radius;
    if (auto outcome = run.trigger(2.0 * length / goal.speed + 5.0); !outcome) {
      return outcome;
    }
    run.result().distance = run.registers().get_double(19);
    return run.registers().get_int(19) != 0
               ? ur_ros_rtde::Outcome::success()
               : ur_ros_rtde::Outcome::failure(
                     ur_ros_rtde::ErrorCode::not_reached,
                     "no contact within radius: start at another place, or increase radius");
  }
};

UR_ROS_RTDE_EXPORT(SpiralSearch, "spiral_search")

}  // namespace ur_ros_rtde_tutorials
