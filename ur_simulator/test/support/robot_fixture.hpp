#pragma once

#include "safety/safety.hpp"
#include "support/arm_fixture.hpp"
#include "world/world.hpp"

namespace ur_simulator::testing {

/// Arm, world and safety system, advanced in the same order as by the controller.
struct RobotFixture : CyclicFixture {
  explicit RobotFixture(const char * name = "ur10e", const SafetyTimes & times = {}, bool running = true)
      : CyclicFixture(name),
        arm(model, dt, default_position(model)),
        world(model, 1),
        safety(model, dt, {}, times)
  {
    world.set_sensor_noise(0.0, 0.0);
    if (running) {
      safety.start_running(state);
    }
    arm.teleport(default_position(model), state);
  }

  void step() override
  {
    begin_cycle();
    arm.step(state);
    world.step(state);
    if (const auto fault = arm.take_fault()) {
      safety.trigger_protective_stop(*fault);
    }
    actions = safety.step(state);
    if (actions.stop_arm) {
      arm.stop_all(*actions.stop_arm);
    }
    paused += actions.pause_program ? 1 : 0;
    resumed += actions.resume_program ? 1 : 0;
    stopped += actions.stop_program ? 1 : 0;
  }
  Surface table_below(double distance, double stiffness, double damping = 50.0) const
  {
    Surface surface;
    surface.point = state.actual_tcp_pose.head<3>() - distance * Vector3::UnitZ();
    surface.elasticity.stiffness = stiffness;
    surface.elasticity.damping = damping;
    return surface;
  }
  StartResult move_down(double distance, double speed)
  {
    Vector6 to = state.target_tcp_pose;
    to[2] -= distance;
    return arm.move_linear(to, {1.2, speed});
  }
  std::string log()
  {
    std::string text;
    while (const auto event = safety.take_event()) {
      text += event->message + "\n";
    }
    return text;
  }

  Arm arm;
  World world;
  Safety safety;
  SafetyActions actions;
  int paused = 0, resumed = 0, stopped = 0;  ///< how often the safety system requested it
};

}  // namespace ur_simulator::testing
