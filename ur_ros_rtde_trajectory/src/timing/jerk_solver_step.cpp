#include <algorithm>
#include <cmath>
#include <utility>

#include "timing/jerk_solver.hpp"

// One iteration of the solver: the linear system of the perturbed KKT conditions and the step lengths.

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double fraction_to_boundary = 0.95;  // fraction-to-boundary rule

}  // namespace

void JerkSolver::assemble(double target)
{
  system_.clear(count());
  for (std::size_t i = 0; i < count(); ++i) {
    if (i > 0) {
      add_station(i, target);
    }
    add_interval(i, target);
  }
  for (const std::size_t fixed : {std::size_t{0}, count() - 1}) {  // zero at rest
    system_.diagonal[fixed] = 1.0;
    system_.right[fixed] = 0.0;
  }
  system_.first[0] = system_.second[0] = 0.0;
  system_.first[count() - 2] = system_.second[count() - 3] = 0.0;
}

void JerkSolver::add_station(std::size_t m, double target)
{
  const Multipliers & l = multipliers_[m];
  const double f = limit_fractions_.acceleration[m];
  const Joints pa = grid_.d2[m] * inverse_acceleration_;
  const Joints pb = grid_.d1[m] * inverse_acceleration_;
  const Joints plus = (f - acceleration_use_[m]).inverse();
  const Joints minus = (f + acceleration_use_[m]).inverse();
  const Joints stiffness = l.station_plus * plus + l.station_minus * minus;
  const Joints push = target * (plus - minus);
  Model model;
  model.aa = (stiffness * pa * pa).sum();
  model.ab = (stiffness * pa * pb).sum();
  model.bb = (stiffness * pb * pb).sum();
  model.ga = (push * pa).sum();
  model.gb = (push * pb).sum();

  const double room = max_a_[m] - a_[m];
  model.aa += l.speed / (max_a_[m] * room);
  model.ga += target / room;

  const double time = weight_[m] * spline_->speed(m) / std::sqrt(a_[m]);
  model.ga -= 0.5 * time / a_[m];
  model.aa += 0.3 * time / (a_[m] * a_[m]);
  scatter_model(m, m, model);
}

void JerkSolver::add_interval(std::size_t i, double target)
{
  const Multipliers & l = multipliers_[i];
  const double f = limit_fractions_.jerk[i];
  scatter_model(i, begin_jerk_[i].at, jerk_model(begin_jerk_[i], f, l.begin_plus, l.begin_minus, target));
  scatter_model(i, end_jerk_[i].at, jerk_model(end_jerk_[i], f, l.end_plus, l.end_minus, target));
}

JerkSolver::Model JerkSolver::jerk_model(const JerkRow & row, double f, const Joints & plus,
                                         const Joints & minus, double target)
{
  const Joints up = (f - row.value).inverse();
  const Joints down = (f + row.value).inverse();
  const Joints both = plus * up + minus * down;
  const Joints tilt = row.tangent * (plus * up - minus * down);
  const Joints push = target * (up - down);
  const Joints weighted_a = both * row.pa + tilt;
  Model model;
  model.aa = ((weighted_a + tilt) * row.pa + (row.tangent * row.tangent) * both).sum();
  model.ab = (weighted_a * row.pb).sum();
  model.ac = (weighted_a * row.pc).sum();
  model.bb = (both * row.pb * row.pb).sum();
  model.bc = (both * row.pb * row.pc).sum();
  model.cc = (both * row.pc * row.pc).sum();
  model.ga = (push * row.pa).sum() + target * row.tangent * (up + down).sum();
  model.gb = (push * row.pb).sum();
  model.gc = (push * row.pc).sum();
  return model;
}

// Adds a quadratic model in (a_m, b_m, c_i), m = i or i + 1, to the linear system in w.
void JerkSolver::scatter_model(std::size_t i, std::size_t m, const Model & model)
{
  // Rows of a, b, c over (w_(i-1), w_i, w_(i+1)).
  const double shift_left = spline_->at(i).g;  // 0 at the ends
  const double shift_right = spline_->at(i + 1).g;
  const double rate = 1.0 / spline_->duration(i);
  const auto & at = spline_->at(m);
  double ra[3] = {0, 0, 0};
  double rb[3] = {0, 0, 0};
  const std::size_t k = m - i;
  ra[k] = 1.0 - at.l;
  ra[k + 1] = at.l;
  rb[k] = -at.g;
  rb[k + 1] = at.g;
  const double rc[3] = {shift_left * rate, -(shift_left + shift_right) * rate, shift_right * rate};
  double pa[3], pb[3], pc[3];
  for (int n = 0; n < 3; ++n) {
    pa[n] = model.aa * ra[n] + model.ab * rb[n] + model.ac * rc[n];
    pb[n] = model.ab * ra[n] + model.bb * rb[n] + model.bc * rc[n];
    pc[n] = model.ac * ra[n] + model.bc * rb[n] + model.cc * rc[n];
  }
  const auto entry = [&](int row, int column) {
    return ra[row] * pa[column] + rb[row] * pb[column] + rc[row] * pc[column];
  };
  const auto force = [&](int row) { return ra[row] * model.ga + rb[row] * model.gb + rc[row] * model.gc; };
  if (i > 0) {
    system_.diagonal[i - 1] += entry(0, 0);
    system_.first[i - 1] += entry(0, 1);
    system_.right[i - 1] -= force(0);
  }
  system_.diagonal[i] += entry(1, 1);
  system_.right[i] -= force(1);
  if (i + 1 < count()) {
    system_.first[i] += entry(1, 2);
    system_.diagonal[i + 1] += entry(2, 2);
    system_.right[i + 1] -= force(2);
  }
  if (i > 0 && i + 1 < count()) {
    system_.second[i - 1] += entry(0, 2);
  }
}

JerkSolver::StepLengths JerkSolver::step_lengths(const std::vector<double> & dw, double target)
{
  StepLengths steps;
  for (std::size_t i = 0; i < count(); ++i) {
    if (i > 0) {
      station_step_lengths(i, spline_->a(dw, i), spline_->b(dw, i), target, steps);
    }
    const double f = limit_fractions_.jerk[i];
    const double dc = (spline_->b(dw, i + 1) - spline_->b(dw, i)) / spline_->duration(i);
    const Multipliers & l = multipliers_[i];
    Multipliers & d = multiplier_step_[i];
    const auto move = [&](const JerkRow & row) {
      const double da = spline_->a(dw, row.at);
      return std::pair<Joints, double>(row.pa * da + row.pb * spline_->b(dw, row.at) + row.pc * dc,
                                       row.tangent * da);
    };
    const auto [begin, begin_tangent] = move(begin_jerk_[i]);
    const auto [end, end_tangent] = move(end_jerk_[i]);
    update_multipliers(f - begin_jerk_[i].value, begin + begin_tangent, l.begin_plus, target, d.begin_plus,
                       steps);
    update_multipliers(f + begin_jerk_[i].value, begin_tangent - begin, l.begin_minus, target, d.begin_minus,
                       steps);
    update_multipliers(f - end_jerk_[i].value, end + end_tangent, l.end_plus, target, d.end_plus, steps);
    update_multipliers(f + end_jerk_[i].value, end_tangent - end, l.end_minus, target, d.end_minus, steps);
  }
  return steps;
}

// One side of six constraints with slack `room`, of which a full step consumes `used`: computes the
// multiplier step and reduces the step lengths.
void JerkSolver::update_multipliers(const Joints & room, const Joints & used, const Joints & multiplier,
                                    double target, Joints & change, StepLengths & steps)
{
  const Joints inverse = room.inverse();
  change = (target + multiplier * used) * inverse - multiplier;
  const double fastest = (used * inverse).maxCoeff();
  const double dual = (-change / multiplier).maxCoeff();
  steps.primal =
      fastest * steps.primal > fraction_to_boundary ? fraction_to_boundary / fastest : steps.primal;
  steps.dual = dual * steps.dual > fraction_to_boundary ? fraction_to_boundary / dual : steps.dual;
}

void JerkSolver::station_step_lengths(std::size_t m, double da, double db, double target, StepLengths & steps)
{
  const Multipliers & l = multipliers_[m];
  Multipliers & d = multiplier_step_[m];
  const double f = limit_fractions_.acceleration[m];
  const Joints dx = (grid_.d2[m] * da + grid_.d1[m] * db) * inverse_acceleration_;
  update_multipliers(f - acceleration_use_[m], dx, l.station_plus, target, d.station_plus, steps);
  update_multipliers(f + acceleration_use_[m], -dx, l.station_minus, target, d.station_minus, steps);

  const double room = 1.0 - a_[m] / max_a_[m];
  const double used = da / max_a_[m];
  d.speed = (target + l.speed * used) / room - l.speed;
  if (used > 0.0) {
    steps.primal = std::min(steps.primal, fraction_to_boundary * room / used);
  }
  if (da < 0.0) {
    steps.primal = std::min(steps.primal, -0.8 * a_[m] / da);
  }
  if (d.speed < 0.0) {
    steps.dual = std::min(steps.dual, -fraction_to_boundary * l.speed / d.speed);
  }
}

void JerkSolver::advance(const std::vector<double> & dw, const StepLengths & steps)
{
  for (std::size_t i = 0; i < count(); ++i) {
    w_[i] += steps.primal * dw[i];
    Multipliers & l = multipliers_[i];
    const Multipliers & d = multiplier_step_[i];
    if (i > 0) {
      l.station_plus += steps.dual * d.station_plus;
      l.station_minus += steps.dual * d.station_minus;
      l.speed += steps.dual * d.speed;
    }
    l.begin_plus += steps.dual * d.begin_plus;
    l.begin_minus += steps.dual * d.begin_minus;
    l.end_plus += steps.dual * d.end_plus;
    l.end_minus += steps.dual * d.end_minus;
  }
  evaluate();
}

}  // namespace ur_ros_rtde::trajectory
