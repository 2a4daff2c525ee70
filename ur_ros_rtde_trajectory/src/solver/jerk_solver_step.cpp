#include <algorithm>
#include <cmath>

#include "solver/jerk_solver.hpp"

// One iteration of the solver: the linear system of the perturbed KKT conditions and the step lengths.

namespace ur_ros_rtde::trajectory {

void JerkSolver::assemble(double target)
{
  std::fill(begin_models_.begin(), begin_models_.end(), QuadraticModel{});
  std::fill(end_models_.begin(), end_models_.end(), QuadraticModel{});
  for_each_block([&](const auto & block) {
    block.add_to((block.station == block.interval ? begin_models_ : end_models_)[block.interval], target);
  });
  system_.clear(count());
  for (std::size_t i = 0; i < count(); ++i) {
    if (i > 0) {
      add_time_and_speed(i, target);
      scatter_model(i, i, begin_models_[i]);
    }
    if (i + 1 < count()) {
      scatter_model(i, i + 1, end_models_[i]);
    }
  }
  for (const std::size_t fixed : {std::size_t{0}, count() - 1}) {  // zero at rest
    system_.diagonal[fixed] = 1.0;
    system_.right[fixed] = 0.0;
  }
  system_.first[0] = system_.second[0] = 0.0;
  system_.first[count() - 2] = system_.second[count() - 3] = 0.0;
}

void JerkSolver::add_time_and_speed(std::size_t m, double target)
{
  QuadraticModel & model = begin_models_[m];
  const double room = max_a_[m] - a_[m];
  model.aa += speed_[m].value / (max_a_[m] * room);
  model.ga += target / room;

  const double time = weight_[m] * spline_->speed(m) / std::sqrt(a_[m]);
  model.ga -= 0.5 * time / a_[m];
  model.aa += 0.3 * time / (a_[m] * a_[m]);
}

// Adds a quadratic model in (a_m, b_m, c_i), m = i or i + 1, to the linear system in w.
void JerkSolver::scatter_model(std::size_t i, std::size_t m, const QuadraticModel & model)
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

StepLengths JerkSolver::step_lengths(const std::vector<double> & dw, double target)
{
  StepLengths lengths;
  for (std::size_t m = 0; m <= count(); ++m) {
    da_[m] = spline_->a(dw, m);
    db_[m] = spline_->b(dw, m);
  }
  for (std::size_t i = 0; i < count(); ++i) {
    dc_[i] = (db_[i + 1] - db_[i]) / spline_->duration(i);
    if (i > 0) {
      step_speed(i, da_[i], target, lengths);
    }
  }
  for_each_block([&](auto & block) {
    block.step(da_[block.station], db_[block.station], dc_[block.interval], target, lengths);
  });
  return lengths;
}

void JerkSolver::step_speed(std::size_t m, double da, double target, StepLengths & lengths)
{
  SpeedMultiplier & multiplier = speed_[m];
  const double room = 1.0 - a_[m] / max_a_[m];
  const double used = da / max_a_[m];
  multiplier.step = (target + multiplier.value * used) / room - multiplier.value;
  if (used > 0.0) {
    lengths.primal = std::min(lengths.primal, fraction_to_boundary * room / used);
  }
  if (da < 0.0) {
    lengths.primal = std::min(lengths.primal, -0.8 * a_[m] / da);
  }
  if (multiplier.step < 0.0) {
    lengths.dual = std::min(lengths.dual, -fraction_to_boundary * multiplier.value / multiplier.step);
  }
}

// Takes the step. Returns the mean complementarity afterwards.
double JerkSolver::advance(const std::vector<double> & dw, const StepLengths & lengths)
{
  for (std::size_t i = 0; i < count(); ++i) {
    w_[i] += lengths.primal * dw[i];
  }
  set_states();
  double sum = 0.0;
  for (std::size_t m = 1; m < count(); ++m) {
    speed_[m].value += lengths.dual * speed_[m].step;
    sum += speed_[m].value * (1.0 - a_[m] / max_a_[m]);
  }
  for_each_block([&](auto & block) {
    block.advance_multipliers(lengths.dual);
    evaluate(block);
    sum += block.complementarity();
  });
  return sum / rows_;
}

}  // namespace ur_ros_rtde::trajectory
