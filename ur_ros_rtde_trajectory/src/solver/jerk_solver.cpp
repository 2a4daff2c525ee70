#include "solver/jerk_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/topp_ra.hpp"

namespace ur_ros_rtde::trajectory {

JerkSolver::JerkSolver(const Limits & limits, SearchLimit search_limit)
    : limits_(limits),
      search_limit_(std::move(search_limit)),
      inverse_acceleration_(limits.acceleration.inverse()),
      inverse_jerk_(limits.jerk.inverse())
{
}

void JerkSolver::set_problem(const Grid & grid, const LimitFractions & limit_fractions, double long_interval,
                             bool near_solution)
{
  grid_ = &grid;
  limit_fractions_ = &limit_fractions;
  long_interval_ = long_interval;
  near_solution_ = near_solution;
  for (auto * of_stations : {&max_a_, &weight_, &a_, &b_, &da_, &db_}) {
    of_stations->assign(grid.stations(), 0.0);
  }
  c_.assign(grid.intervals(), 0.0);
  dc_.assign(grid.intervals(), 0.0);
  speed_.assign(grid.stations(), {});
  begin_models_.resize(grid.intervals());
  end_models_.resize(grid.intervals());
  std::apply([](auto &... blocks) { (blocks.clear(), ...); }, blocks_);
  rows_ = 0.0;
  for (std::size_t m = 0; m < grid.stations(); ++m) {
    const double fraction = limit_fractions.velocity[m];
    max_a_[m] = std::min(fraction * fraction * max_squared_speed(grid, m, limits_), 1e12);
  }
}

// Adds the blocks for the spline and the coefficients at the start.
void JerkSolver::add_blocks()
{
  using Block = ConstraintBlock<joint_count>;
  for (std::size_t i = 0; i < count(); ++i) {
    Block block;
    block.interval = static_cast<std::uint32_t>(i);
    if (i > 0) {
      block.kind = Block::Kind::acceleration;
      block.station = static_cast<std::uint32_t>(i);
      block.ka = grid_->d2[i] * inverse_acceleration_;
      block.kb = grid_->d1[i] * inverse_acceleration_;
      add_block(block);
    }
    const bool inner = i > 0 && i + 1 < count();
    const bool is_curved = (grid_->d3_begin[i] != 0.0).any() || (grid_->d3_end[i] != 0.0).any();
    if (inner && is_curved && spline_->duration(i) > long_interval_) {
      block.kind = Block::Kind::middle_acceleration;
      block.joint = {0, 1, 2, 3, 4, 5};
      set_middle(block);
      add_block(block);
    }
    for (const bool end : {false, true}) {
      // At rest, a and b are zero. Its speed is that of the adjacent station.
      const std::size_t station = end ? i + 1 : i;
      const bool rest = station == 0 || station == count();
      block.kind = end ? Block::Kind::end_jerk : Block::Kind::begin_jerk;
      block.station = static_cast<std::uint32_t>(rest ? (end ? count() - 1 : 1) : station);
      block.ka = block.kb = Joints::Zero();
      if (!rest) {
        block.ka = (end ? grid_->d3_end[i] : grid_->d3_begin[i]) * inverse_jerk_;
        block.kb = grid_->d2[station] * inverse_jerk_ * 3.0;
      }
      block.kc = grid_->d1[station] * inverse_jerk_;
      add_block(block);
    }
  }
  rows_ = static_cast<double>(count());
  for_each_block([&](const auto & block) { rows_ += 2.0 * static_cast<double>(block.value.size()); });
}

// How close each row is to binding: the room of the row that binds first over the room of this row, where b
// (acceleration) or c (jerk) changes in either direction and everything else is constant.
Joints JerkSolver::closeness(const ConstraintBlock<joint_count> & block) const
{
  const double a = a_[block.station];
  const double b = b_[block.station];
  double scale = 1.0;
  Joints constant = block.ka * a;
  Joints slope = block.kb;
  if (block.is_jerk()) {
    const double v = std::sqrt(a);
    constant = (block.ka * a + block.kb * b) * v;
    slope = block.kc;
    scale = v / spline_->speed(block.station);
  }
  slope *= scale;
  const Joints range = slope.abs().max(1e-9).inverse();
  const Joints middle = -constant / (slope.abs() < 1e-9).select(Joints::Constant(1e-9), slope);
  const Joints low = middle - range;
  const Joints high = middle + range;
  const double least = high.minCoeff();
  const double most = low.maxCoeff();
  const double span = std::max(least - most, 1e-3 * range.minCoeff());
  const Joints result = span * (high - most).min(least - low).max(0.1 * span).inverse();
  return result.isNaN().select(Joints::Ones(), result);  // at vanishing speed
}

template <int rows>
void JerkSolver::add_rows(const ConstraintBlock<joint_count> & block,
                          const std::array<std::uint8_t, joint_count> & joints)
{
  ConstraintBlock<rows> part;
  part.kind = static_cast<typename ConstraintBlock<rows>::Kind>(block.kind);
  part.interval = block.interval;
  part.station = block.station;
  for (std::size_t k = 0; k < rows; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    part.joint[k] = joints[k];
    part.ka[row] = block.ka[joints[k]];
    part.kb[row] = block.kb[joints[k]];
    part.kc[row] = block.kc[joints[k]];
  }
  std::get<std::vector<ConstraintBlock<rows>>>(blocks_).push_back(part);
}

// Adds the limits of the joints that matter.
void JerkSolver::add_block(const ConstraintBlock<joint_count> & block)
{
  constexpr double nearly_binding = 0.6;  // closeness
  std::array<std::uint8_t, joint_count> joints{0, 1, 2, 3, 4, 5};
  const bool is_jerk = block.is_jerk();
  if ((block.ka == 0.0).all() && (!is_jerk || (block.kb == 0.0).all())) {
    // On a line, the rows are proportional: the largest binds.
    Eigen::Index largest = 0;
    (is_jerk ? block.kc : block.kb).abs().maxCoeff(&largest);
    joints[0] = static_cast<std::uint8_t>(largest);
    add_rows<1>(block, joints);
    return;
  }
  Eigen::Index count = joint_count;
  if (near_solution_) {
    Joints close = closeness(block);
    const unsigned required = required_joints(block);
    for (unsigned j = 0; j < joint_count; ++j) {
      if ((required >> j & 1U) != 0U) {
        close[j] = 1.0;
      }
    }
    std::sort(joints.begin(), joints.end(),
              [&](std::uint8_t left, std::uint8_t right) { return close[left] > close[right]; });
    count = (close > nearly_binding).count();
  }
  if (count <= 2) {
    add_rows<2>(block, joints);
  } else if (count <= 4) {
    add_rows<4>(block, joints);
  } else {
    add_rows<6>(block, joints);
  }
}

// Joints whose limits must not be left out: bit j for joint j. A station belongs to both of its intervals.
unsigned JerkSolver::required_joints(const ConstraintBlock<joint_count> & block) const
{
  const auto & joints = limit_fractions_->binding_joints;
  const std::size_t i = block.interval;
  const bool at_station = block.kind == ConstraintBlock<joint_count>::Kind::acceleration;
  return joints[i] | (at_station ? joints[i - 1] : 0U);
}

// Coefficients of the acceleration in the middle of an interval, from the cubic interpolation of q'.
template <int rows>
void JerkSolver::set_middle(ConstraintBlock<rows> & block) const
{
  const std::size_t i = block.interval;
  const double width = grid_->width(i);
  const double half = 0.5 * width;
  const double v = spline_->speed(i);
  const double slope = (spline_->speed(i + 1) - v) / spline_->duration(i);
  // Time at which the interval is half covered.
  const double time = width / (v + std::sqrt(std::max(v * v + 2.0 * slope * half, 0.0)));
  const Joints d1 =
      0.5 * (grid_->d1[i] + grid_->d1[i + 1]) + 0.125 * width * (grid_->d2[i] - grid_->d2[i + 1]);
  const Joints d2 =
      1.5 / width * (grid_->d1[i + 1] - grid_->d1[i]) - 0.25 * (grid_->d2[i] + grid_->d2[i + 1]);
  // b = b_i + c t and a = a_i + 2 b_i s + 2 c * (integral of t over s)
  const Joints ka = d2 * inverse_acceleration_;
  const Joints kb = d1 * inverse_acceleration_;
  for (std::size_t k = 0; k < rows; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const auto joint = static_cast<Eigen::Index>(block.joint[k]);
    block.ka[row] = ka[joint];
    block.kb[row] = kb[joint] + ka[joint] * width;
    block.kc[row] = kb[joint] * time + ka[joint] * (time * time * (v + 2.0 / 3.0 * slope * time));
  }
}

void JerkSolver::start(const SpeedSpline & spline, std::vector<double> w, double gap)
{
  w_ = std::move(w);
  set_spline(spline);
  const double mu = gap * duration() / rows_;
  for_each_block([&](auto & block) { block.center_multipliers(mu); });
  for (std::size_t m = 1; m < count(); ++m) {
    speed_[m].value = mu / std::max(1.0 - a_[m] / max_a_[m], 1e-9);
  }
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
  if (rows_ == 0.0) {
    set_states();
    add_blocks();
  }
  for_each_block([&](auto & block) {
    block.limit = block.is_jerk() ? limit_fractions_->jerk[block.interval]
                                  : limit_fractions_->acceleration[block.interval];
    if (block.kind == std::decay_t<decltype(block)>::Kind::middle_acceleration) {
      block.limit = std::min(block.limit, limit_fractions_->acceleration[block.interval + 1]);
      set_middle(block);
    }
  });
  evaluate();
  scale_to_limits(0.98);
}

void JerkSolver::set_states()
{
  for (std::size_t m = 0; m <= count(); ++m) {
    a_[m] = spline_->a(w_, m);
    b_[m] = spline_->b(w_, m);
  }
  for (std::size_t i = 0; i < count(); ++i) {
    c_[i] = (b_[i + 1] - b_[i]) / spline_->duration(i);
  }
}

void JerkSolver::evaluate()
{
  set_states();
  for_each_block([&](auto & block) { evaluate(block); });
}

// Largest ratio to the limits, as a factor on a. The jerk grows with a^(3/2).
double JerkSolver::limit_ratio() const
{
  double worst = 0.0;
  double jerk = 0.0;
  for (std::size_t m = 1; m < count(); ++m) {
    worst = std::max(worst, a_[m] / max_a_[m]);
  }
  for_each_block([&](const auto & block) {
    double & largest = block.is_jerk() ? jerk : worst;
    largest = std::max(largest, block.use());
  });
  return std::max(worst, std::cbrt(jerk * jerk));
}

std::vector<double> JerkSolver::limit_ratios(const SpeedSpline & spline, const std::vector<double> & w)
{
  spline_ = &spline;
  w_ = w;
  if (rows_ == 0.0) {
    set_states();
    add_blocks();
  }
  evaluate();
  std::vector<double> result(count());
  std::vector<double> jerk(count());
  for_each_block([&](const auto & block) {
    double & largest = (block.is_jerk() ? jerk : result)[block.interval];
    largest = std::max(largest, block.use());
  });
  for (std::size_t m = 0; m < count(); ++m) {
    result[m] = std::max({result[m], m > 0 ? a_[m] / max_a_[m] : 0.0, std::cbrt(jerk[m] * jerk[m])});
  }
  return result;
}

void JerkSolver::scale_to_limits(double target)
{
  for (int round = 0; round < 20; ++round) {
    const double worst = limit_ratio();
    if (worst <= target * 1.01) {
      return;
    }
    for (double & value : w_) {
      value *= target / worst;
    }
    evaluate();
  }
}

double JerkSolver::mean_complementarity() const
{
  double sum = 0.0;
  for_each_block([&](const auto & block) { sum += block.complementarity(); });
  for (std::size_t m = 1; m < count(); ++m) {
    sum += speed_[m].value * (1.0 - a_[m] / max_a_[m]);
  }
  return sum / rows_;
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
  return mean_complementarity() * rows_ / duration();
}

void JerkSolver::iterate(int steps, double gap_limit)
{
  double reduction = 0.3;
  double before = duration();
  bool settled = false;
  double product = mean_complementarity();
  std::vector<double> last_w;
  for (int step = 0; step < steps && !(settled && product * rows_ < gap_limit * before); ++step) {
    if (has_to_end()) {
      return;
    }
    assemble(reduction * product);
    if (!system_.solve()) {
      return;  // the current iterate is feasible
    }
    const StepLengths lengths = step_lengths(system_.right, reduction * product);
    last_w = w_;
    product = advance(system_.right, lengths);
    const double now = duration();
    if (!std::isfinite(now)) {
      w_ = last_w;
      evaluate();
      return;
    }
    const double shorter = std::min(lengths.primal, lengths.dual);
    reduction = shorter > 0.8 ? 0.1 : shorter > 0.5 ? 0.25 : shorter > 0.2 ? 0.6 : 1.0;
    settled = lengths.primal > 0.5 && std::abs(before - now) < 2.0 * gap_limit * now;
    before = now;
  }
}

}  // namespace ur_ros_rtde::trajectory
