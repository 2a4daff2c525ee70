#pragma once

#include <cstdint>
#include <vector>

#include "common/types.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// An elastic half space: everything below the plane through `point` with outward unit `normal` (base frame) pushes the TCP back.
struct Surface {
  Vector3 point = Vector3::Zero();             ///< m
  Vector3 normal = Vector3::UnitZ();
  double stiffness = 20000.0;                  ///< N/m
  double damping = 50.0;                       ///< N s/m
  double friction = 0.0;                       ///< Coulomb coefficient
};

/// A hand pushing at the TCP: half-sine in time, in base or tool frame.
struct Push {
  Vector6 wrench = Vector6::Zero();  ///< peak, N and N m
  double duration = 0.3;             ///< s
  bool tool_frame = false;
};

/// What surrounds the arm, and the force/torque sensor that feels it. Deterministic for a given seed.
class World {
 public:
  World(double cycle_time, std::uint64_t seed);
  std::uint32_t place_surface(const Surface & surface);
  void clear_surfaces();
  void push(const Push & push);
  void zero_sensor();
  /// Noise of the sensor's reading, standard deviation in N and N m (0 switches it off).
  void set_sensor_noise(double force, double torque);
  /// Computes the wrench on the tool from the actual state and writes the force fields.
  void step(ControllerState & state);

 private:
  struct ActivePush;
  // (the owner of this room completes this)
};

}  // namespace ur_simulator
