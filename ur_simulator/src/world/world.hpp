#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"
#include "state/controller_state.hpp"
#include "world/contact_detector.hpp"
#include "world/digital_gripper.hpp"
#include "world/force_torque_sensor.hpp"
#include "world/objects.hpp"
#include "world/robotiq_gripper.hpp"
#include "world/soft_gripper.hpp"

namespace ur_simulator {

/// A push at the TCP: a half sine over time, in the base or tool frame.
struct Push {
  Vector6 wrench = Vector6::Zero();  ///< peak, N and N m
  double duration = 0.3;             ///< s
  bool tool_frame = false;
};

/// Environment of the arm and the force/torque sensor. Deterministic for a given seed. Invalid input (not
/// finite, out of range, too many) throws std::invalid_argument with field, value and limit, and has no
/// effect.
class World {
 public:
  static constexpr std::size_t max_pushes = 32;

  World(const RobotModel & model, std::uint64_t seed);
  ObjectList<Surface> & surfaces() { return surfaces_; }
  const ObjectList<Surface> & surfaces() const { return surfaces_; }
  ObjectList<Box> & boxes() { return boxes_; }
  const ObjectList<Box> & boxes() const { return boxes_; }
  ObjectList<Spring> & springs() { return springs_; }
  const ObjectList<Spring> & springs() const { return springs_; }

  void push(const Push & push);
  bool pushing() const { return !pushes_.empty(); }
  void clear_pushes();

  /// The true load at the flange, initially none. It is independent of set_payload(), which sets the load
  /// that the controller assumes.
  void attach_load(const Payload & load);
  const Payload & load() const { return load_; }

  /// The grippers at the flange, nullptr if there is none of this kind.
  SoftGripper * gripper() { return gripper_ ? &*gripper_ : nullptr; }
  const SoftGripper * gripper() const { return gripper_ ? &*gripper_ : nullptr; }
  RobotiqGripper * robotiq_gripper() { return robotiq_gripper_ ? &*robotiq_gripper_ : nullptr; }
  DigitalGripper * digital_gripper() { return digital_gripper_ ? &*digital_gripper_ : nullptr; }
  void mount_gripper() { gripper_.emplace(); }
  void mount_robotiq_gripper() { robotiq_gripper_.emplace(); }
  void mount_digital_gripper(bool double_acting) { digital_gripper_.emplace(double_acting); }

  /// zero_ftsensor(): the reading is relative to that of the next step from then on. RTDE's ft_raw_wrench is
  /// unaffected.
  void zero_sensor();
  /// A program starts.
  void begin_program() { sensor_.begin_program(); }
  /// Standard deviation of the sensor noise, N and N m; 0: no noise.
  void set_sensor_noise(double force, double torque);
  /// tool_contact(): see ContactDetector::cycles_since_contact(); the direction is in the base frame.
  std::size_t cycles_since_contact(const Vector3 & direction, double threshold) const
  {
    return contact_detector_.cycles_since_contact(direction, threshold);
  }
  /// Computes the wrench on the tool from the actual state and writes the force fields of the state.
  void step(ControllerState & state);

 private:
  struct ActivePush {
    Push push;
    double elapsed = 0.0;
  };
  Vector6 contact(const ControllerState & state) const;
  Vector6 advance_pushes(const ControllerState & state);

  double cycle_time_;
  ObjectList<Surface> surfaces_;
  ObjectList<Box> boxes_;
  ObjectList<Spring> springs_;
  std::vector<ActivePush> pushes_;
  Payload load_;
  ForceTorqueSensor sensor_;
  ContactDetector contact_detector_;
  std::optional<SoftGripper> gripper_;
  std::optional<RobotiqGripper> robotiq_gripper_;
  std::optional<DigitalGripper> digital_gripper_;
};

}  // namespace ur_simulator
