#pragma once

#include <array>
#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/cartesian_path.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// What force_mode() asks for. UR's script manual (PolyScope 5, "force_mode") defines the fields.
struct ForceModeSettings {
  /// How the task frame follows from `frame`: `to_point`: y points from the TCP to its origin; `fixed`: as it
  /// is; `along_motion`: x is the TCP's velocity projected on its x-y plane; `tool`: the TCP's own axes
  /// (screw_driving).
  enum class Type { to_point = 1, fixed = 2, along_motion = 3, tool = 4 };

  Vector6 frame = Vector6::Zero();  ///< pose in the base frame; its axes count, wrenches are those of the TCP
  std::array<bool, 6> compliant{};  ///< axes of the task frame that give way
  Vector6 wrench = Vector6::Zero();  ///< N, N m that the robot applies to its surroundings
  Type type = Type::fixed;
  Vector6 limits = Vector6::Zero();  ///< compliant: speed, m/s, rad/s; others: deviation, m, rad
};

/// Superposes compliance on whatever the program does: along compliant axes the TCP moves so that the
/// measured wrench becomes the one asked for, and the program's motion does not count; along the others it
/// follows the program, yielding elastically to the force.
///
/// Compliant axis: v' = scaling / mass * (e + rate_time * de/dt) - damping * v with the wrench's error e,
/// speed and acceleration bounded. The rate of the error brakes on contact, damping alone in free space. Our
/// own law; the manual only says that damping 0 keeps the speed, 1 takes it away quickly, and that scaling
/// above 1 may be unstable on hard surfaces.
class ForceMode {
 public:
  ForceMode(const RobotModel & model, double cycle_time, const ForceModeSettings & settings);

  /// A further call of force_mode(): goes on from the present motion.
  void update(const ForceModeSettings & settings);
  const ForceModeSettings & settings() const { return settings_; }
  /// `program` is where the program's trajectory is; `commanded` where the arm is led to. With `hold` the
  /// compliant axes come to rest (program paused). On a fault `commanded` is left as it was.
  std::optional<MotionFault> advance(const Setpoint & program, const ControllerState & state, double scaling,
                                     double damping, bool hold, Setpoint & commanded);
  /// Takes the deviation along compliant axes over into the program's position, when the program stands
  /// still.
  void fold(const ControllerState & state, Setpoint & program);

  static constexpr double hold_stiffness = 20000.0;        ///< N/m of axes that are not compliant
  static constexpr double hold_turning_stiffness = 500.0;  ///< N m/rad

 private:
  void turn_frame(const Transform & tcp, const Vector6 & program_twist);
  double next_speed(Eigen::Index axis, double error, double error_rate, double damping, double scaling,
                    double speed) const;
  std::optional<MotionFault> beyond_limit(const Vector6 & deviation) const;
  bool compliant(Eigen::Index axis) const;
  Transform displaced(const Transform & tcp) const;

  const RobotModel * model_;
  double cycle_time_;
  ForceModeSettings settings_;
  Eigen::Matrix3d axes_;  ///< of the task frame, in base axes
  bool has_axes_ = true;  ///< along_motion: once the TCP has moved
  bool first_ = true;
  Transform program_before_ = Transform::Identity();
  Vector6 deviation_ = Vector6::Zero();  ///< of the TCP from the program's, base axes
  Vector6 speed_ = Vector6::Zero();      ///< along compliant axes, base axes
  Vector6 force_before_ = Vector6::Zero();
};

}  // namespace ur_simulator
