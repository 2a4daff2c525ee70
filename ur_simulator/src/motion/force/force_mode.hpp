#pragma once

#include <array>
#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "motion/tcp_kinematics.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// Arguments of force_mode(), as defined by UR's script manual (PolyScope 5, "force_mode").
struct ForceModeSettings {
  /// How the task frame follows from `frame`:
  ///  - `to_point`: the y axis points from the TCP to the origin of `frame`;
  ///  - `fixed`: `frame` itself;
  ///  - `along_motion`: the x axis is the TCP velocity projected onto the x-y plane of `frame`;
  ///  - `tool`: the axes of the TCP (screw_driving).
  enum class Type { to_point = 1, fixed = 2, along_motion = 3, tool = 4 };

  Vector6 frame = Vector6::Zero();   ///< pose in the base frame; its axes apply, wrenches act at the TCP
  std::array<bool, 6> compliant{};   ///< compliant axes of the task frame
  Vector6 wrench = Vector6::Zero();  ///< N, N m that the robot applies to its environment
  Type type = Type::fixed;
  Vector6 limits = Vector6::Zero();  ///< compliant axes: speed, m/s, rad/s; others: deviation, m, rad
};

/// Superposes compliance on the motion of the program. Along compliant axes the TCP moves so that the
/// measured wrench becomes the requested one; the program's motion along them is ignored. Along the other
/// axes the TCP follows the program and deviates elastically under force.
///
/// Compliant axis: v' = scaling / virtual_mass * (e + derivative_time * de/dt) - damping * v, where e is the
/// error of the wrench; speed and acceleration are bounded. The rate of the error decelerates the arm on
/// contact; in free space only the damping does. This admittance law is the simulator's own: the manual only
/// says that damping 0 keeps the speed, that damping 1 removes it quickly, and that a scaling above 1 may be
/// unstable on hard surfaces.
class ForceMode {
 public:
  static constexpr double linear_stiffness = 20000.0;  ///< N/m of axes that are not compliant
  static constexpr double angular_stiffness = 500.0;   ///< N m/rad of axes that are not compliant

  ForceMode(const RobotModel & model, double cycle_time, const ForceModeSettings & settings);

  /// Changes the settings and keeps the current motion, as a further call of force_mode() does.
  void update(const ForceModeSettings & settings);
  const ForceModeSettings & settings() const { return settings_; }
  /// `program` is the setpoint of the program's motion, `commanded` the resulting setpoint. With
  /// `hold_position` (program paused) the compliant axes come to rest. On a fault `commanded` is unchanged.
  std::optional<MotionFault> advance(const Setpoint & program, const ControllerState & state, double scaling,
                                     double damping, bool hold_position, Setpoint & commanded);
  /// Adds the deviation along compliant axes to the program's setpoint. The program must stand still.
  void absorb_deviation(const ControllerState & state, Setpoint & program);

 private:
  /// Inputs of one cycle in the task frame.
  struct Measurement {
    Vector6 force = Vector6::Zero();           ///< N, N m
    Vector6 force_rate = Vector6::Zero();      ///< N/s, N m/s
    Vector6 program_motion = Vector6::Zero();  ///< of the program's TCP since the last cycle, m, rad
  };

  Measurement measure(const Transform & program_tcp, const Vector6 & force);
  void update_frame(const Transform & tcp, const Vector6 & program_twist);
  double next_speed(Eigen::Index axis, double error, double error_rate, double damping, double scaling,
                    double speed) const;
  std::optional<MotionFault> check_deviation(const Vector6 & deviation) const;
  bool compliant(Eigen::Index axis) const;
  Transform add_deviation(const Transform & tcp) const;

  const RobotModel * model_;
  double cycle_time_;
  ForceModeSettings settings_;
  Eigen::Matrix3d axes_;      ///< of the task frame, in the base frame
  bool axes_defined_ = true;  ///< along_motion: false until the TCP has moved
  bool first_cycle_ = true;
  Transform previous_program_tcp_ = Transform::Identity();
  Vector6 deviation_ = Vector6::Zero();  ///< of the TCP from the program's TCP, in the base frame
  Vector6 speed_ = Vector6::Zero();      ///< along compliant axes, in the base frame
  Vector6 previous_force_ = Vector6::Zero();
};

}  // namespace ur_simulator
