#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "path/path_builder.hpp"
#include "solver/constraint_block.hpp"
#include "solver/initial_timing.hpp"
#include "timing/resampling.hpp"
#include "timing/s_curve_profile.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

constexpr double step = 0.01;  // s

Limits line_limits()
{
  Limits limits;
  limits.velocity.setConstant(1.0);
  limits.acceleration.setConstant(2.0);
  limits.jerk.setConstant(40.0);
  return limits;
}

// Motion along a line of length 2: 0.05 s of jerk, 0.45 s of constant acceleration, 0.05 s of jerk, 1.45 s of
// constant speed, and the same in reverse.
class LineTest : public testing::Test {
 protected:
  LineTest()
  {
    Joints end = Joints::Zero();
    end[3] = 2.0;
    motion_.path = std::make_shared<Path>(build_path({Joints::Zero(), end}, {}));
    append_s_curve_profile(motion_, 0, line_limits());
  }

  ResampledMotion with_spacing(double spacing) const
  {
    return resample(motion_, 0, std::vector<double>(motion_.timing.size(), spacing), 1);
  }

  Motion motion_;
};

TEST_F(LineTest, IsResampledAtEqualDistancesOfTime)
{
  const ResampledMotion result = with_spacing(step);
  const double duration = motion_.duration();
  ASSERT_EQ(result.grid.intervals(), static_cast<std::size_t>(std::ceil(duration / step)));
  const double width = duration / static_cast<double>(result.grid.intervals());
  double time = 0.0;
  for (std::size_t i = 0; i < result.grid.intervals(); ++i) {
    const PathState state = motion_.timing[motion_.piece_at(time)].at(time);
    EXPECT_NEAR(result.profile.time[i], width, 1e-9);
    EXPECT_NEAR(result.grid.begin[i], state.u, 1e-9);
    EXPECT_NEAR(result.profile.v[i], state.v, 1e-9);
    time += result.profile.time[i];
  }
  EXPECT_NEAR(time, duration, 1e-9);
  EXPECT_EQ(result.profile.v.back(), 0.0);
}

TEST_F(LineTest, HasShortSpacingsOnlyWhereTheJerkChanges)
{
  const ResampledMotion uniform = with_spacing(step);
  const auto spacing = adaptive_spacing(uniform.grid, uniform.profile, line_limits(), step, 1e6);
  double time = 0.0;
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    const double middle = time + 0.5 * uniform.profile.time[i];
    time += uniform.profile.time[i];
    double nearest = motion_.duration();  // distance to a change of the jerk
    for (const TimingLawPiece & piece : motion_.timing) {
      nearest = std::min({nearest, std::abs(middle - piece.start), std::abs(middle - piece.end())});
    }
    EXPECT_GE(spacing[i], step);
    if (nearest < 0.5 * step) {
      EXPECT_LT(spacing[i], 1.5 * step) << "at " << middle << " s";
    } else if (nearest > 0.24) {
      EXPECT_GT(spacing[i], 10.0 * step) << "at " << middle << " s";
    }
  }
}

TEST_F(LineTest, HasAtMostTheGivenNumberOfStations)
{
  const ResampledMotion uniform = with_spacing(step);
  const auto spacing = adaptive_spacing(uniform.grid, uniform.profile, line_limits(), step, 30.0);
  double stations = 0.0;
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    stations += uniform.profile.time[i] / spacing[i];
  }
  EXPECT_LE(stations, 30.0 + 1e-9);
}

TEST_F(LineTest, IsLiftedOnlyWhereItIsMuchSlowerThanNecessary)
{
  const ResampledMotion uniform = with_spacing(step);
  Profile profile = uniform.profile;
  const std::vector<double> highest(profile.v.size(), 1.0);
  EXPECT_FALSE(lift_dips(uniform.grid, profile, highest));  // slow only at both ends
  const std::size_t middle = profile.v.size() / 2;
  for (std::size_t m = middle - 3; m <= middle + 3; ++m) {
    profile.v[m] = 0.1 + 0.1 * std::abs(static_cast<double>(m) - static_cast<double>(middle));
  }
  const auto lifted = lift_dips(uniform.grid, profile, highest);
  ASSERT_TRUE(lifted);
  EXPECT_GT(*std::min_element(lifted->v.begin() + 60, lifted->v.end() - 60), 0.9);
}

// Finite differences of the barrier function of the rows, -target * sum of log(slack), in a, b and c.
TEST(ConstraintBlockTest, ModelMatchesTheBarrierFunction)
{
  constexpr double target = 0.3;
  ConstraintBlock<2> block;
  block.kind = ConstraintBlock<2>::Kind::begin_jerk;
  block.limit = 0.9;
  block.sa = 1.2;
  block.sc = 0.7;
  block.tangent = 0.15;
  block.ka << 0.2, -0.1;
  block.kb << -0.3, 0.25;
  block.kc << 0.15, 0.4;
  const Eigen::Vector3d at(0.6, -0.4, 0.5);
  const auto barrier = [&](const Eigen::Vector3d & x) {
    const Eigen::Array2d value =
        block.ka * (block.sa * x[0]) + block.kb * (block.sa * x[1]) + block.kc * (block.sc * x[2]);
    const double limit = block.limit - block.tangent * (x[0] - at[0]);
    return -target * ((limit - value).log() + (limit + value).log()).sum();
  };
  block.evaluate(at[0], at[1], at[2]);
  block.center_multipliers(target);
  QuadraticModel model;
  block.add_to(model, target);
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  constexpr double h = 1e-4;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d di = h * Eigen::Vector3d::Unit(i);
    gradient[i] = (barrier(at + di) - barrier(at - di)) / (2.0 * h);
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d dj = h * Eigen::Vector3d::Unit(j);
      hessian(i, j) =
          (barrier(at + di + dj) - barrier(at + di - dj) - barrier(at - di + dj) + barrier(at - di - dj)) /
          (4.0 * h * h);
    }
  }
  EXPECT_NEAR(model.ga, gradient[0], 1e-6);
  EXPECT_NEAR(model.gb, gradient[1], 1e-6);
  EXPECT_NEAR(model.gc, gradient[2], 1e-6);
  EXPECT_NEAR(model.aa, hessian(0, 0), 1e-5);
  EXPECT_NEAR(model.ab, hessian(0, 1), 1e-5);
  EXPECT_NEAR(model.ac, hessian(0, 2), 1e-5);
  EXPECT_NEAR(model.bb, hessian(1, 1), 1e-5);
  EXPECT_NEAR(model.bc, hessian(1, 2), 1e-5);
  EXPECT_NEAR(model.cc, hessian(2, 2), 1e-5);
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
