#include "trajectory/jerk_solver.hpp"

#include <algorithm>
#include <cmath>

#include "trajectory/reach.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double to_the_border = 0.95;  // part of the way to the nearest limit that a step may go
constexpr double rows_per_interval = 6.0 * joint_count + 1.0;

}  // namespace

JerkSolver::JerkSolver(const Grid & grid, const Limits & limits, const Allowance & allowance)
    : grid_(grid),
      allowance_(allowance),
      inverse_acceleration_(limits.acceleration.inverse()),
      inverse_jerk_(limits.jerk.inverse()),
      ceiling_(grid.stations()),
      weight_(grid.stations()),
      a_(grid.stations()),
      b_(grid.stations()),
      c_(grid.intervals()),
      use_(grid.intervals()),
      begin_rows_(grid.intervals()),
      end_rows_(grid.intervals()),
      multipliers_(grid.intervals()),
      change_(grid.intervals())
{
  for (std::size_t m = 0; m < grid.stations(); ++m) {
    ceiling_[m] = std::min(highest_square_speed(grid.d1[m], limits), 1e12);
  }
}

void JerkSolver::start(const SpeedSpline & spline, std::vector<double> w)
{
  w_ = std::move(w);
  spline_ = &spline;
  change_spline(spline);
  const double mu = 0.1 * duration() / static_cast<double>(count());
  for (Multipliers & m : multipliers_) {
    for (Joints * values :
         {&m.station_plus, &m.station_minus, &m.begin_plus, &m.begin_minus, &m.end_plus, &m.end_minus}) {
      values->setConstant(mu);
    }
    m.speed = mu;
  }
  balance_multipliers(mu, 1.0);
}

void JerkSolver::change_spline(const SpeedSpline & spline)
{
  spline_ = &spline;
  for (std::size_t i = 1; i + 1 < count(); ++i) {
    // The other weights must not make a speed vanish.
    const double neighbours = std::min(i > 1 ? a_[i] : w_[i], i + 2 < count() ? a_[i + 1] : w_[i]);
    w_[i] = std::max(w_[i], 0.3 * neighbours);
  }
  std::fill(weight_.begin(), weight_.end(), 0.0);
  for (std::size_t i = 0; i < count(); ++i) {
    // The ends are at rest: their share goes to the station beside them.
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
      use_[i] = (grid_.d2[i] * a_[i] + grid_.d1[i] * b_[i]) * inverse_acceleration_;
    }
    begin_rows_[i] = jerk_row(i, false);
    end_rows_[i] = jerk_row(i, true);
  }
}

// Largest use of the limits of station m and of the interval that begins there, as the factor on a: jerk
// grows with a^(3/2).
double JerkSolver::excess(std::size_t m) const
{
  double worst = 0.0;
  if (m > 0) {
    worst = std::max(a_[m] / ceiling_[m], use_[m].abs().maxCoeff() / allowance_.acceleration[m]);
  }
  const double jerk =
      begin_rows_[m].value.abs().max(end_rows_[m].value.abs()).maxCoeff() / allowance_.jerk[m];
  return std::max(worst, std::cbrt(jerk * jerk));
}

std::vector<double> JerkSolver::excesses(const SpeedSpline & spline, const std::vector<double> & w)
{
  spline_ = &spline;
  w_ = w;
  evaluate();
  std::vector<double> result(count());
  for (std::size_t m = 0; m < count(); ++m) {
    result[m] = excess(m);
  }
  return result;
}

void JerkSolver::scale_to_limits(double target)
{
  for (int round = 0; round < 20; ++round) {
    double worst = 0.0;
    for (std::size_t m = 0; m < count(); ++m) {
      worst = std::max(worst, excess(m));
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
  row.tangent = 0.5 * allowance_.jerk[i] / a_[row.at];
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

// Moves each multiplier to within a factor `spread` of mu / slack.
void JerkSolver::balance_multipliers(double mu, double spread)
{
  const auto balance = [&](Joints & multiplier, const Joints & slack) {
    const Joints centre = mu * slack.max(1e-9).inverse();
    multiplier = multiplier.max(centre / spread).min(centre * spread);
  };
  for (std::size_t i = 0; i < count(); ++i) {
    Multipliers & m = multipliers_[i];
    if (i > 0) {
      balance(m.station_plus, allowance_.acceleration[i] - use_[i]);
      balance(m.station_minus, allowance_.acceleration[i] + use_[i]);
      const double centre = mu / std::max(1.0 - a_[i] / ceiling_[i], 1e-9);
      m.speed = std::clamp(m.speed, centre / spread, centre * spread);
    }
    balance(m.begin_plus, allowance_.jerk[i] - begin_rows_[i].value);
    balance(m.begin_minus, allowance_.jerk[i] + begin_rows_[i].value);
    balance(m.end_plus, allowance_.jerk[i] - end_rows_[i].value);
    balance(m.end_minus, allowance_.jerk[i] + end_rows_[i].value);
  }
}

double JerkSolver::mean_product() const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < count(); ++i) {
    const Multipliers & m = multipliers_[i];
    if (i > 0) {
      const double f = allowance_.acceleration[i];
      sum += (m.station_plus * (f - use_[i]) + m.station_minus * (f + use_[i])).sum();
      sum += m.speed * (1.0 - a_[i] / ceiling_[i]);
    }
    const double f = allowance_.jerk[i];
    const Joints & begin = begin_rows_[i].value;
    const Joints & end = end_rows_[i].value;
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
  return mean_product() * rows_per_interval * static_cast<double>(count()) / duration();
}

void JerkSolver::improve(int steps, double gap_limit)
{
  double reduction = 0.3;
  double before = duration();
  bool settled = false;
  double product = mean_product();
  const double rows = rows_per_interval * static_cast<double>(count());
  std::vector<double> last_w;
  for (int step = 0; step < steps && !(settled && product * rows < gap_limit * before); ++step) {
    assemble(reduction * product);
    if (!system_.solve()) {
      return;  // the present iterate obeys the limits
    }
    const Steps lengths = find_step(system_.right, reduction * product);
    last_w = w_;
    advance(system_.right, lengths);
    const double now = duration();
    if (!std::isfinite(now)) {
      w_ = last_w;
      evaluate();
      return;
    }
    product = mean_product();
    const double shorter = std::min(lengths.primal, lengths.dual);
    reduction = shorter > 0.8 ? 0.1 : shorter > 0.5 ? 0.25 : shorter > 0.2 ? 0.6 : 1.0;
    settled = lengths.primal > 0.5 && std::abs(before - now) < 2.0 * gap_limit * now;
    before = now;
  }
}

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
  const double f = allowance_.acceleration[m];
  const Joints pa = grid_.d2[m] * inverse_acceleration_;
  const Joints pb = grid_.d1[m] * inverse_acceleration_;
  const Joints plus = (f - use_[m]).inverse();
  const Joints minus = (f + use_[m]).inverse();
  const Joints stiffness = l.station_plus * plus + l.station_minus * minus;
  const Joints push = target * (plus - minus);
  Model model;
  model.aa = (stiffness * pa * pa).sum();
  model.ab = (stiffness * pa * pb).sum();
  model.bb = (stiffness * pb * pb).sum();
  model.ga = (push * pa).sum();
  model.gb = (push * pb).sum();

  const double room = ceiling_[m] - a_[m];
  model.aa += l.speed / (ceiling_[m] * room);
  model.ga += target / room;

  const double time = weight_[m] * spline_->speed(m) / std::sqrt(a_[m]);
  model.ga -= 0.5 * time / a_[m];
  model.aa += 0.3 * time / (a_[m] * a_[m]);
  spread_model(m, m, model);
}

void JerkSolver::add_interval(std::size_t i, double target)
{
  const Multipliers & l = multipliers_[i];
  const double f = allowance_.jerk[i];
  spread_model(i, begin_rows_[i].at, jerk_model(begin_rows_[i], f, l.begin_plus, l.begin_minus, target));
  spread_model(i, end_rows_[i].at, jerk_model(end_rows_[i], f, l.end_plus, l.end_minus, target));
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

// Adds a model in (a_m, b_m, c_i), m = i or i + 1, to the system in w.
void JerkSolver::spread_model(std::size_t i, std::size_t m, const Model & model)
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

JerkSolver::Steps JerkSolver::find_step(const std::vector<double> & dw, double target)
{
  Steps steps;
  for (std::size_t i = 0; i < count(); ++i) {
    if (i > 0) {
      station_step(i, spline_->a(dw, i), spline_->b(dw, i), target, steps);
    }
    const double f = allowance_.jerk[i];
    const double dc = (spline_->b(dw, i + 1) - spline_->b(dw, i)) / spline_->duration(i);
    const Multipliers & l = multipliers_[i];
    Multipliers & d = change_[i];
    const auto move = [&](const JerkRow & row) {
      const double da = spline_->a(dw, row.at);
      return std::pair<Joints, double>(row.pa * da + row.pb * spline_->b(dw, row.at) + row.pc * dc,
                                       row.tangent * da);
    };
    const auto [begin, begin_tangent] = move(begin_rows_[i]);
    const auto [end, end_tangent] = move(end_rows_[i]);
    limit_step(f - begin_rows_[i].value, begin + begin_tangent, l.begin_plus, target, d.begin_plus, steps);
    limit_step(f + begin_rows_[i].value, begin_tangent - begin, l.begin_minus, target, d.begin_minus, steps);
    limit_step(f - end_rows_[i].value, end + end_tangent, l.end_plus, target, d.end_plus, steps);
    limit_step(f + end_rows_[i].value, end_tangent - end, l.end_minus, target, d.end_minus, steps);
  }
  return steps;
}

// One side of six limits with `room` left, of which a full step takes `used`.
void JerkSolver::limit_step(const Joints & room, const Joints & used, const Joints & multiplier,
                            double target, Joints & change, Steps & steps)
{
  const Joints inverse = room.inverse();
  change = (target + multiplier * used) * inverse - multiplier;
  const double fastest = (used * inverse).maxCoeff();
  const double dual = (-change / multiplier).maxCoeff();
  steps.primal = fastest * steps.primal > to_the_border ? to_the_border / fastest : steps.primal;
  steps.dual = dual * steps.dual > to_the_border ? to_the_border / dual : steps.dual;
}

void JerkSolver::station_step(std::size_t m, double da, double db, double target, Steps & steps)
{
  const Multipliers & l = multipliers_[m];
  Multipliers & d = change_[m];
  const double f = allowance_.acceleration[m];
  const Joints dx = (grid_.d2[m] * da + grid_.d1[m] * db) * inverse_acceleration_;
  limit_step(f - use_[m], dx, l.station_plus, target, d.station_plus, steps);
  limit_step(f + use_[m], -dx, l.station_minus, target, d.station_minus, steps);

  const double room = 1.0 - a_[m] / ceiling_[m];
  const double used = da / ceiling_[m];
  d.speed = (target + l.speed * used) / room - l.speed;
  if (used > 0.0) {
    steps.primal = std::min(steps.primal, to_the_border * room / used);
  }
  if (da < 0.0) {
    steps.primal = std::min(steps.primal, -0.8 * a_[m] / da);
  }
  if (d.speed < 0.0) {
    steps.dual = std::min(steps.dual, -to_the_border * l.speed / d.speed);
  }
}

void JerkSolver::advance(const std::vector<double> & dw, const Steps & steps)
{
  for (std::size_t i = 0; i < count(); ++i) {
    w_[i] += steps.primal * dw[i];
    Multipliers & l = multipliers_[i];
    const Multipliers & d = change_[i];
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
