#include "timing/jerk_solver.hpp"

#include <algorithm>
#include <cmath>

#include "timing/topp_ra.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double rows_per_interval = 6.0 * joint_count + 1.0;

}  // namespace

JerkSolver::JerkSolver(const Grid & grid, const Limits & limits, const LimitFractions & limit_fractions)
    : grid_(grid),
      limit_fractions_(limit_fractions),
      inverse_acceleration_(limits.acceleration.inverse()),
      inverse_jerk_(limits.jerk.inverse()),
      max_a_(grid.stations()),
      weight_(grid.stations()),
      a_(grid.stations()),
      b_(grid.stations()),
      c_(grid.intervals()),
      acceleration_use_(grid.intervals()),
      begin_jerk_(grid.intervals()),
      end_jerk_(grid.intervals()),
      multipliers_(grid.intervals()),
      multiplier_step_(grid.intervals())
{
  for (std::size_t m = 0; m < grid.stations(); ++m) {
    max_a_[m] = std::min(max_squared_speed(grid, m, limits), 1e12);
  }
}

void JerkSolver::start(const SpeedSpline & spline, std::vector<double> w, double gap)
{
  w_ = std::move(w);
  spline_ = &spline;
  set_spline(spline);
  const double mu = gap * duration() / (rows_per_interval * static_cast<double>(count()));
  for (Multipliers & m : multipliers_) {
    for (Joints * values :
         {&m.station_plus, &m.station_minus, &m.begin_plus, &m.begin_minus, &m.end_plus, &m.end_minus}) {
      values->setConstant(mu);
    }
    m.speed = mu;
  }
  center_multipliers(mu, 1.0);
}

void JerkSolver::set_spline(const SpeedSpline & spline)
{
  spline_ = &spline;
  for (std::size_t i = 1; i + 1 < count(); ++i) {
    // With the new weights, no speed may vanish.
    const double neighbors = std::min(i > 1 ? a_[i] : w_[i], i + 2 < count() ? a_[i + 1] : w_[i]);
    w_[i] = std::max(w_[i], 0.3 * neighbors);
  }
  std::fill(weight_.begin(), weight_.end(), 0.0);
  for (std::size_t i = 0; i < count(); ++i) {
    // Both ends are at rest: their weight goes to the adjacent station.
    weight_[std::max<std::size_t>(i, 1)] += 0.5 * spline.duration(i);
    weight_[std::min(i + 1, count() - 1)] += 0.5 * spline.duration(i);
  }
  evaluate();
  scale_to_limits(0.98);
}

void JerkSolver::evaluate()
{
  for (std::size_t m = 0; m <= count(); ++m) {
    a_[m] = spline_->a(w_, m);
    b_[m] = spline_->b(w_, m);
  }
  for (std::size_t i = 0; i < count(); ++i) {
    c_[i] = (b_[i + 1] - b_[i]) / spline_->duration(i);
    if (i > 0) {
      acceleration_use_[i] = (grid_.d2[i] * a_[i] + grid_.d1[i] * b_[i]) * inverse_acceleration_;
    }
    begin_jerk_[i] = jerk_row(i, false);
    end_jerk_[i] = jerk_row(i, true);
  }
}

// Largest ratio of station m and the interval that starts there to their limits, as a factor on a. The jerk
// grows with a^(3/2).
double JerkSolver::limit_ratio(std::size_t m) const
{
  double worst = 0.0;
  if (m > 0) {
    worst =
        std::max(a_[m] / max_a_[m], acceleration_use_[m].abs().maxCoeff() / limit_fractions_.acceleration[m]);
  }
  const double jerk =
      begin_jerk_[m].value.abs().max(end_jerk_[m].value.abs()).maxCoeff() / limit_fractions_.jerk[m];
  return std::max(worst, std::cbrt(jerk * jerk));
}

std::vector<double> JerkSolver::limit_ratios(const SpeedSpline & spline, const std::vector<double> & w)
{
  spline_ = &spline;
  w_ = w;
  evaluate();
  std::vector<double> result(count());
  for (std::size_t m = 0; m < count(); ++m) {
    result[m] = limit_ratio(m);
  }
  return result;
}

void JerkSolver::scale_to_limits(double target)
{
  for (int round = 0; round < 20; ++round) {
    double worst = 0.0;
    for (std::size_t m = 0; m < count(); ++m) {
      worst = std::max(worst, limit_ratio(m));
    }
    if (worst <= target * 1.01) {
      return;
    }
    for (double & value : w_) {
      value *= target / worst;
    }
    evaluate();
  }
}

JerkSolver::JerkRow JerkSolver::jerk_row(std::size_t i, bool end) const
{
  const std::size_t station = end ? i + 1 : i;
  const bool rest = station == 0 || station == count();
  JerkRow row;
  row.at = rest ? (station == 0 ? 1 : count() - 1) : station;
  const double v = std::sqrt(a_[row.at]);
  row.tangent = 0.5 * limit_fractions_.jerk[i] / a_[row.at];
  row.pc = grid_.d1[station] * inverse_jerk_ * (v / spline_->speed(row.at));
  if (rest) {
    row.pa.setZero();
    row.pb.setZero();
  } else {
    row.pa = (end ? grid_.d3_end[i] : grid_.d3_begin[i]) * inverse_jerk_ * v;
    row.pb = grid_.d2[station] * inverse_jerk_ * (3.0 * v);
  }
  row.value = row.pa * a_[row.at] + row.pb * b_[row.at] + row.pc * c_[i];
  return row;
}

// Limits each multiplier to mu / slack within a factor of `spread`.
void JerkSolver::center_multipliers(double mu, double spread)
{
  const auto balance = [&](Joints & multiplier, const Joints & slack) {
    const Joints center = mu * slack.max(1e-9).inverse();
    multiplier = multiplier.max(center / spread).min(center * spread);
  };
  for (std::size_t i = 0; i < count(); ++i) {
    Multipliers & m = multipliers_[i];
    if (i > 0) {
      balance(m.station_plus, limit_fractions_.acceleration[i] - acceleration_use_[i]);
      balance(m.station_minus, limit_fractions_.acceleration[i] + acceleration_use_[i]);
      const double center = mu / std::max(1.0 - a_[i] / max_a_[i], 1e-9);
      m.speed = std::clamp(m.speed, center / spread, center * spread);
    }
    balance(m.begin_plus, limit_fractions_.jerk[i] - begin_jerk_[i].value);
    balance(m.begin_minus, limit_fractions_.jerk[i] + begin_jerk_[i].value);
    balance(m.end_plus, limit_fractions_.jerk[i] - end_jerk_[i].value);
    balance(m.end_minus, limit_fractions_.jerk[i] + end_jerk_[i].value);
  }
}

double JerkSolver::mean_complementarity() const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < count(); ++i) {
    const Multipliers & m = multipliers_[i];
    if (i > 0) {
      const double f = limit_fractions_.acceleration[i];
      sum +=
          (m.station_plus * (f - acceleration_use_[i]) + m.station_minus * (f + acceleration_use_[i])).sum();
      sum += m.speed * (1.0 - a_[i] / max_a_[i]);
    }
    const double f = limit_fractions_.jerk[i];
    const Joints & begin = begin_jerk_[i].value;
    const Joints & end = end_jerk_[i].value;
    sum += (m.begin_plus * (f - begin) + m.begin_minus * (f + begin) + m.end_plus * (f - end) +
            m.end_minus * (f + end))
               .sum();
  }
  return sum / (rows_per_interval * static_cast<double>(count()));
}

double JerkSolver::duration() const
{
  double total = 0.0;
  for (std::size_t m = 1; m < count(); ++m) {
    total += weight_[m] * spline_->speed(m) / std::sqrt(a_[m]);
  }
  return total;
}

double JerkSolver::gap() const
{
  return mean_complementarity() * rows_per_interval * static_cast<double>(count()) / duration();
}

void JerkSolver::iterate(int steps, double gap_limit)
{
  double reduction = 0.3;
  double before = duration();
  bool settled = false;
  double product = mean_complementarity();
  const double rows = rows_per_interval * static_cast<double>(count());
  std::vector<double> last_w;
  for (int step = 0; step < steps && !(settled && product * rows < gap_limit * before); ++step) {
    assemble(reduction * product);
    if (!system_.solve()) {
      return;  // the current iterate is feasible
    }
    const StepLengths lengths = step_lengths(system_.right, reduction * product);
    last_w = w_;
    advance(system_.right, lengths);
    const double now = duration();
    if (!std::isfinite(now)) {
      w_ = last_w;
      evaluate();
      return;
    }
    product = mean_complementarity();
    const double shorter = std::min(lengths.primal, lengths.dual);
    reduction = shorter > 0.8 ? 0.1 : shorter > 0.5 ? 0.25 : shorter > 0.2 ? 0.6 : 1.0;
    settled = lengths.primal > 0.5 && std::abs(before - now) < 2.0 * gap_limit * now;
    before = now;
  }
}

}  // namespace ur_ros_rtde::trajectory
