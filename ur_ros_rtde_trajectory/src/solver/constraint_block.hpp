#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// Quadratic model in a and b of a station and c of an interval.
struct QuadraticModel {
  double aa = 0, ab = 0, ac = 0, bb = 0, bc = 0, cc = 0, ga = 0, gb = 0, gc = 0;
};

/// Lengths of a step of the solver, as fractions of the full step.
struct StepLengths {
  double primal = 1.0, dual = 1.0;
};

inline constexpr double fraction_to_boundary = 0.95;  // fraction-to-boundary rule

/// Limits of one quantity of several joints, |ka sa a + kb sa b + kc sc c| <= limit, with a and b of a
/// station and c of an interval; their multipliers and the steps of these. Only the scales sa and sc and the
/// tangent depend on the current iterate.
template <int rows>
struct ConstraintBlock {
  using Rows = Eigen::Array<double, rows, 1>;

  enum class Kind : std::uint8_t { acceleration, middle_acceleration, begin_jerk, end_jerk };

  Kind kind = Kind::acceleration;
  std::uint32_t interval = 0;
  std::uint32_t station = 0;
  std::array<std::uint8_t, rows> joint{};  ///< of each row
  double limit = 1.0;
  double sa = 1.0, sc = 1.0;
  double tangent = 0.0;  ///< decrease of the limit per a
  Rows ka = Rows::Zero(), kb = Rows::Zero(), kc = Rows::Zero();
  Rows value = Rows::Zero();
  Rows plus = Rows::Zero(), minus = Rows::Zero();  ///< multipliers of the upper and the lower limit
  Rows plus_step = Rows::Zero(), minus_step = Rows::Zero();

  bool is_jerk() const { return kind >= Kind::begin_jerk; }

  void evaluate(double a, double b, double c) { value = ka * (sa * a) + kb * (sa * b) + kc * (sc * c); }

  /// Largest ratio of a row to the limit.
  double use() const { return value.abs().maxCoeff() / limit; }

  void center_multipliers(double mu)
  {
    plus = mu * (limit - value).max(1e-9).inverse();
    minus = mu * (limit + value).max(1e-9).inverse();
  }

  double complementarity() const { return (plus * (limit - value) + minus * (limit + value)).sum(); }

  /// Adds the second-order model of the rows at the barrier parameter `target`.
  void add_to(QuadraticModel & model, double target) const
  {
    const Rows up = (limit - value).inverse();
    const Rows down = (limit + value).inverse();
    const Rows plus_up = plus * up;
    const Rows minus_down = minus * down;
    const Rows both = plus_up + minus_down;
    const Rows push = up - down;
    const Rows both_a = both * ka;
    const Rows both_b = both * kb;
    model.aa += sa * sa * (both_a * ka).sum();
    model.ab += sa * sa * (both_a * kb).sum();
    model.bb += sa * sa * (both_b * kb).sum();
    model.ga += target * sa * (push * ka).sum();
    model.gb += target * sa * (push * kb).sum();
    if (kind == Kind::acceleration) {
      return;
    }
    model.ac += sa * sc * (both_a * kc).sum();
    model.bc += sa * sc * (both_b * kc).sum();
    model.cc += sc * sc * (both * kc * kc).sum();
    model.gc += target * sc * (push * kc).sum();
    if (is_jerk()) {
      const Rows tilt = tangent * (plus_up - minus_down);
      model.aa += 2.0 * sa * (tilt * ka).sum() + tangent * tangent * both.sum();
      model.ab += sa * (tilt * kb).sum();
      model.ac += sc * (tilt * kc).sum();
      model.ga += target * tangent * (up + down).sum();
    }
  }

  /// Computes the steps of the multipliers for the step (da, db, dc) and reduces the step lengths.
  void step(double da, double db, double dc, double target, StepLengths & lengths)
  {
    const Rows change = ka * (sa * da) + kb * (sa * db) + kc * (sc * dc);
    step_side(limit - value, change + tangent * da, plus, target, plus_step, lengths);
    step_side(limit + value, tangent * da - change, minus, target, minus_step, lengths);
  }

  void advance_multipliers(double length)
  {
    plus += length * plus_step;
    minus += length * minus_step;
  }

 private:
  // `room`: slack, of which a full step consumes `used`.
  static void step_side(const Rows & room, const Rows & used, const Rows & multiplier, double target,
                        Rows & multiplier_step, StepLengths & lengths)
  {
    const Rows inverse = room.inverse();
    const Rows part = used * inverse;
    multiplier_step = target * inverse + multiplier * (part - 1.0);
    const double fastest = part.maxCoeff();
    if (fastest * lengths.primal > fraction_to_boundary) {
      lengths.primal = fraction_to_boundary / fastest;
    }
    if ((-lengths.dual * multiplier_step > fraction_to_boundary * multiplier).any()) {
      lengths.dual = fraction_to_boundary / (-multiplier_step / multiplier).maxCoeff();
    }
  }
};

}  // namespace ur_ros_rtde::trajectory
