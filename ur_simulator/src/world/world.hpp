#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/types.hpp"
#include "state/controller_state.hpp"
#include "world/contact_watch.hpp"
#include "world/sensor.hpp"
#include "world/soft_gripper.hpp"

namespace ur_simulator {

/// An elastic half space: everything below the plane through `point` with outward unit `normal` (base frame)
/// pushes the TCP back.
struct Surface {
  Vector3 point = Vector3::Zero();    ///< m
  Vector3 normal = Vector3::UnitZ();  ///< any length but 0; normalised when placed
  double stiffness = 20000.0;         ///< N/m
  double damping = 50.0;              ///< N s/m
  double friction = 0.0;              ///< Coulomb coefficient
};

/// A hand pushing at the TCP: half-sine in time, in base or tool frame.
struct Push {
  Vector6 wrench = Vector6::Zero();  ///< peak, N and N m
  double duration = 0.3;             ///< s
  bool tool_frame = false;
};

/// A surface as it is placed, with the name it was given.
struct PlacedSurface {
  std::uint32_t id;
  Surface surface;
};

/// What surrounds the arm, and the force/torque sensor that feels it. Deterministic for a given seed. Wrong
/// input (not finite, out of range, too many) throws std::invalid_argument with field, value and limit, and
/// changes nothing.
class World {
 public:
  static constexpr std::size_t max_surfaces = 32;
  static constexpr std::size_t max_pushes = 32;

  World(double cycle_time, std::uint64_t seed);
  /// Returns the surface's id.
  std::uint32_t place_surface(const Surface & surface);
  /// False when there is none of this id.
  bool remove_surface(std::uint32_t id);
  void clear_surfaces();
  const std::vector<PlacedSurface> & surfaces() const { return surfaces_; }

  void push(const Push & push);
  bool pushing() const { return !pushes_.empty(); }
  void clear_pushes();

  /// What really hangs at the flange (nothing at first), whatever set_payload() told the controller.
  void attach_load(const Payload & load);
  const Payload & load() const { return load_; }

  /// A gripper at the flange, or nullptr.
  SoftGripper * gripper() { return gripper_ ? &*gripper_ : nullptr; }
  const SoftGripper * gripper() const { return gripper_ ? &*gripper_ : nullptr; }
  void mount_gripper() { gripper_.emplace(); }

  /// zero_ftsensor(): the reading becomes 0 at the next step, then shows changes from there. RTDE's
  /// ft_raw_wrench goes on unchanged.
  void zero_sensor();
  /// Noise of the sensor's reading, standard deviation in N and N m (0 switches it off).
  void set_sensor_noise(double force, double torque);
  /// tool_contact(): how many cycles ago a contact began that holds the tool up in this direction (base axes,
  /// any length; zero: whichever), 0 when there is none.
  std::size_t contact_steps(const Vector3 & direction, double threshold) const
  {
    return contact_watch_.steps(direction, threshold);
  }
  /// Computes the wrench on the tool from the actual state and writes the force fields.
  void step(ControllerState & state);

 private:
  struct ActivePush {
    Push push;
    double elapsed = 0.0;
  };
  Vector6 contact(const ControllerState & state) const;
  Vector6 advance_pushes(const ControllerState & state);

  double cycle_time_;
  std::uint32_t next_id_ = 1;
  std::vector<PlacedSurface> surfaces_;
  std::vector<ActivePush> pushes_;
  Payload load_;
  ForceTorqueSensor sensor_;
  ContactWatch contact_watch_;
  std::optional<SoftGripper> gripper_;
};

}  // namespace ur_simulator
