#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"
#include "support/random_vectors.hpp"

namespace ur_simulator::testing {

/// Simulated robot of a test, which is advanced cycle by cycle.
class CyclicFixture {
 public:
  explicit CyclicFixture(const char * model_name) : model(model_named(model_name)), dt(model.cycle_time()) {}
  virtual ~CyclicFixture() = default;
  CyclicFixture(const CyclicFixture &) = delete;
  CyclicFixture & operator=(const CyclicFixture &) = delete;

  /// Advances by one cycle.
  virtual void step() = 0;
  void run(double seconds)
  {
    for (double t = 0.0; t < seconds - 0.5 * dt; t += dt) {
      step();
    }
  }
  /// Steps until the condition holds; the test fails after `limit` s of simulated time. Returns the elapsed
  /// time, s.
  double until(const std::function<bool()> & condition, double limit)
  {
    double t = 0.0;
    bool holds = condition();
    while (!holds && t < limit) {
      step();
      t += dt;
      holds = condition();
    }
    EXPECT_TRUE(holds) << "not within " << limit << " s of simulated time";
    return t;
  }

  const RobotModel & model;
  double dt;  ///< s, cycle time
  ControllerState state;

 protected:
  void begin_cycle()
  {
    ++state.cycle;
    state.timestamp = static_cast<double>(state.cycle) * dt;
  }
};

}  // namespace ur_simulator::testing
