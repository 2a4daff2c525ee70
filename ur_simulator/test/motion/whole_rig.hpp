#pragma once

#include "arm_rig.hpp"
#include "safety/safety.hpp"
#include "world/world.hpp"

namespace ur_simulator::testing {

/// Arm, world and safety as the controller runs them, cycle by cycle.
struct WholeRig {
  explicit WholeRig(const char * name = "ur10e", const SafetyTimes & times = {}, bool running = true)
      : model(model_named(name)),
        dt(model.cycle_time()),
        arm(model, dt, default_position(model)),
        world(dt, 1),
        safety(model, dt, {}, times)
  {
    world.set_sensor_noise(0.0, 0.0);
    if (running) {
      safety.start_running(state);
    }
    arm.teleport(default_position(model), state);
  }

  void step()
  {
    ++state.cycle;
    state.timestamp = static_cast<double>(state.cycle) * dt;
    arm.step(state);
    world.step(state);
    if (const auto fault = arm.take_fault()) {
      safety.trip(*fault);
    }
    orders = safety.step(state);
    if (orders.halt) {
      arm.halt(*orders.halt);
    }
    paused += orders.pause_program ? 1 : 0;
    resumed += orders.resume_program ? 1 : 0;
    stopped += orders.stop_program ? 1 : 0;
  }
  void run(double seconds)
  {
    for (double t = 0.0; t < seconds - 0.5 * dt; t += dt) {
      step();
    }
  }
  double until(const std::function<bool()> & reached, double limit)
  {
    double t = 0.0;
    bool is_reached = reached();
    while (!is_reached && t < limit) {
      step();
      t += dt;
      is_reached = reached();
    }
    EXPECT_TRUE(is_reached) << "not within " << limit << " s of simulated time";
    return t;
  }
  Surface table_below(double distance, double stiffness, double damping = 50.0) const
  {
    Surface surface;
    surface.point = state.actual_tcp_pose.head<3>() - distance * Vector3::UnitZ();
    surface.stiffness = stiffness;
    surface.damping = damping;
    return surface;
  }
  MotionStart move_down(double distance, double speed)
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

  const RobotModel & model;
  double dt;
  ControllerState state;
  Arm arm;
  World world;
  Safety safety;
  SafetyOrders orders;
  int paused = 0, resumed = 0, stopped = 0;
};

}  // namespace ur_simulator::testing
