// The patched getters of ur_rtde return the answer to their own query and use their arguments.
#include <cmath>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// m, rad: two readings of the arm at rest, and what is computed from them, differ by less.
constexpr double reading_noise = 3e-4;

using Joints = std::vector<double>;

const Joints elsewhere{0.4, -1.1, 1.4, -1.7, -1.4, 0.3};

double distance(const std::vector<double> & a, const std::vector<double> & b)
{
  double largest = a.size() == b.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

struct QueryTest : RobotFixture {
  Joints now() { return robot->receive()->getActualQ(); }
};

TEST_F(QueryTest, ReturnsItsOwnAnswerNotThePreviousOne)
{
  make_both();
  EXPECT_NEAR(control()->getStepTime(), 0.002, 1e-9) << "first query";
  const auto flange = control()->getForwardKinematics(now(), Joints(6, 0.0));
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT(distance(control()->getActualToolFlangePose(), flange), reading_noise);
    EXPECT_NEAR(control()->getStepTime(), 0.002, 1e-9);
    EXPECT_LT(distance(control()->getActualJointPositionsHistory(0), now()), reading_noise);
    EXPECT_LT(distance(control()->getTargetJointAccelerations(), Joints(6, 0.0)), 1e-6);
    EXPECT_EQ(control()->getTCPOffset(), Joints(6, 0.0));
  }
}

TEST_F(QueryTest, ForwardKinematicsUseTheGivenTcp)
{
  make_both();
  const Joints tcp{0.0, 0.0, 0.1, 0.0, 0.0, 0.0};
  const auto flange = control()->getForwardKinematics(elsewhere, Joints(6, 0.0));
  ASSERT_TRUE(control()->setTcp(tcp));
  EXPECT_LT(distance(control()->getTCPOffset(), tcp), 1e-7) << "registers have 32 bits";
  control()->poseTrans({1.0, 2.0, 3.0, 0.0, 0.0, 0.0}, {4.0, 5.0, 6.0, 0.0, 0.0, 0.0});
  const auto with_active = control()->getForwardKinematics(elsewhere, {});
  const auto with_given = control()->getForwardKinematics(elsewhere, tcp);
  EXPECT_LT(distance(with_active, with_given), 1e-9);
  EXPECT_GT(distance(with_active, flange), 0.01);
  EXPECT_LT(distance(control()->getForwardKinematics({}, tcp), control()->getForwardKinematics(now(), tcp)),
            reading_noise);
}

TEST_F(QueryTest, JacobianUsesItsArguments)
{
  make_both();
  const Joints tcp{0.05, 0.0, 0.2, 0.0, 0.0, 0.0};
  const auto jacobian = control()->getJacobian(elsewhere, tcp);
  ASSERT_EQ(jacobian.size(), 36U);
  // Compares each column with finite differences of the forward kinematics.
  const double step = 5e-3;
  for (std::size_t joint = 0; joint < 6; ++joint) {
    auto before = elsewhere;
    auto after = elsewhere;
    before[joint] -= step;
    after[joint] += step;
    const auto from = control()->getForwardKinematics(before, tcp);
    const auto to = control()->getForwardKinematics(after, tcp);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(jacobian[6 * joint + axis], (to[axis] - from[axis]) / (2.0 * step), 5e-5);
    }
  }
  EXPECT_LT(distance(control()->getJacobian(), control()->getJacobian(now(), Joints(6, 0.0))), reading_noise);
  EXPECT_THROW(control()->getJacobian({1.0, 2.0}), std::invalid_argument);
  EXPECT_TRUE(robot->ready_to_move()) << "bad arguments must not stop the program";
}

TEST_F(QueryTest, DynamicsUseTheirArguments)
{
  make_both();
  const auto here = control()->getMassMatrix();
  EXPECT_LT(distance(here, control()->getMassMatrix(now())), 1e-3);
  const auto there = control()->getMassMatrix(elsewhere);
  EXPECT_GT(distance(here, there), 0.01);
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      EXPECT_NEAR(there[6 * row + column], there[6 * column + row], 1e-9) << "it is symmetric";
    }
  }
  const Joints turning{0.5, -0.5, 0.4, 0.3, -0.2, 0.1};
  const auto torques = control()->getCoriolisAndCentrifugalTorques(elsewhere, turning);
  auto faster = turning;
  for (auto & velocity : faster) {
    velocity *= 2.0;
  }
  const auto torques_faster = control()->getCoriolisAndCentrifugalTorques(elsewhere, faster);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(torques_faster[i], 4.0 * torques[i], 1e-6) << "they grow with the square of the velocity";
  }
  EXPECT_GT(distance(torques, Joints(6, 0.0)), 0.01);
  const auto derivative = control()->getJacobianTimeDerivative(elsewhere, turning, Joints(6, 0.0));
  auto before = elsewhere;
  auto after = elsewhere;
  for (std::size_t i = 0; i < 6; ++i) {
    before[i] -= 1e-3 * turning[i];
    after[i] += 1e-3 * turning[i];
  }
  const auto from = control()->getJacobian(before, Joints(6, 0.0));
  const auto to = control()->getJacobian(after, Joints(6, 0.0));
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_NEAR(derivative[i], (to[i] - from[i]) / 2e-3, 1e-4);
  }
}

TEST_F(QueryTest, DoesNotWriteOtherRegisters)
{
  make_both();
  ScriptOptions secondary;
  secondary.kind = ScriptKind::secondary;
  secondary.timeout = 5s;
  ASSERT_TRUE(
      run_script("write_output_float_register(13, 7.5)\nwrite_output_float_register(19, 8.5)\n", secondary));
  control()->getMassMatrix();
  control()->getJacobian();
  Sample sample = *robot->latest();
  ASSERT_TRUE(robot->wait_for_next(sample, 1s));
  EXPECT_EQ(sample.output_double_registers[1], 7.5);
  EXPECT_EQ(sample.output_double_registers[7], 8.5);
}

TEST_F(QueryTest, DoesNotInterruptServoMotion)
{
  make_both();
  auto q = now();
  for (int i = 0; i < 20; ++i) {
    q[0] += 0.001;
    ASSERT_TRUE(control()->servoJ(q, 0.0, 0.0, 0.01, 0.1, 300.0));
    EXPECT_EQ(control()->getTCPOffset().size(), 6U);
    EXPECT_NEAR(control()->getStepTime(), 0.002, 1e-9);
  }
  EXPECT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_q[0] - q[0]) < 2e-3; }, 2s))
      << robot->latest()->actual_q[0] - q[0];
  EXPECT_TRUE(robot->stop_motion());
}

}  // namespace
}  // namespace ur_ros_rtde::test
