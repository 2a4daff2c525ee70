#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "common/pose.hpp"
#include "dynamics/dynamics.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "support/random_vectors.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::model_named;
using testing::RandomVectors;

Payload some_payload()
{
  Payload payload;
  payload.mass = 2.5;
  payload.center_of_gravity = Vector3(0.02, -0.05, 0.12);
  payload.inertia << 0.02, 0.03, 0.025, 0.001, -0.002, 0.003;
  return payload;
}

class DynamicsOfEveryModelTest : public ::testing::TestWithParam<const char *> {
 protected:
  DynamicsOfEveryModelTest() : model(model_named(GetParam())), dynamics(model), random(7)
  {
    dynamics.set_payload(some_payload());
  }
  const RobotModel & model;
  Dynamics dynamics;
  RandomVectors random;
};

TEST_P(DynamicsOfEveryModelTest, GravityTorquesAreTheGradientOfThePotentialEnergy)
{
  dynamics.set_gravity(Vector3(1.0, -2.0, 9.5));
  const Vector6 q = random.six(pi);
  const Vector6 torques = dynamics.gravity_torques(q);
  constexpr double step = 1e-5;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double slope = (dynamics.potential_energy(q + step * Vector6::Unit(i)) -
                          dynamics.potential_energy(q - step * Vector6::Unit(i))) /
                         (2.0 * step);
    // The potential energy of the last link includes the payload.
    EXPECT_NEAR(torques[i], slope, 1e-5) << i;
  }
}

TEST_P(DynamicsOfEveryModelTest, MassMatrixIsSymmetricPositiveDefinite)
{
  for (int i = 0; i < 50; ++i) {
    const Matrix6 mass = dynamics.mass_matrix(random.six(pi));
    EXPECT_LT((mass - mass.transpose()).norm(), 1e-12);
    EXPECT_EQ(Eigen::LLT<Matrix6>(mass).info(), Eigen::Success);
  }
}

TEST_P(DynamicsOfEveryModelTest, TorquesAreTheSumOfInertiaCoriolisAndGravity)
{
  const Vector6 q = random.six(pi), qd = random.six(2.0), qdd = random.six(5.0);
  const Vector6 sum =
      dynamics.mass_matrix(q) * qdd + dynamics.coriolis_torques(q, qd) + dynamics.gravity_torques(q);
  EXPECT_LT((dynamics.inverse_dynamics(q, qd, qdd) - sum).norm(), 1e-9);
}

/// Kinetic energy by definition: from the velocity of the center of mass and the rotation of every link, by
/// finite differences of its frame.
double kinetic_energy_by_definition(const RobotModel & model, const Payload & payload, const Vector6 & q,
                                    const Vector6 & qd)
{
  constexpr double step = 1e-6;
  const auto previous = link_frames(model, q - step * qd);
  const auto setpoint = link_frames(model, q);
  const auto after = link_frames(model, q + step * qd);
  double energy = 0.0;
  const auto add = [&](std::size_t i, double mass, const Vector3 & center, const Eigen::Matrix3d & inertia) {
    const Vector3 velocity = (after[i] * center - previous[i] * center) / (2.0 * step);
    const Vector3 angular = setpoint[i].linear().transpose() *
                            to_rotation_vector(after[i].linear() * previous[i].linear().transpose()) /
                            (2.0 * step);
    energy += 0.5 * mass * velocity.squaredNorm() + 0.5 * angular.dot(inertia * angular);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    add(i, model.links[i].mass, model.links[i].center_of_mass, model.links[i].inertia);
  }
  const auto & p = payload.inertia;
  Eigen::Matrix3d inertia;
  inertia << p[0], p[3], p[4], p[3], p[1], p[5], p[4], p[5], p[2];
  add(5, payload.mass, payload.center_of_gravity, inertia);
  return energy;
}

TEST_P(DynamicsOfEveryModelTest, KineticEnergyIsThatOfLinksAndPayload)
{
  for (int i = 0; i < 10; ++i) {
    const Vector6 q = random.six(pi), qd = random.six(2.0);
    const double expected = kinetic_energy_by_definition(model, some_payload(), q, qd);
    EXPECT_NEAR(dynamics.kinetic_energy(q, qd), expected, 1e-6 * std::max(1.0, expected));
  }
}

TEST_P(DynamicsOfEveryModelTest, CoriolisTorquesDoOnlyTheWorkOfTheMassMatrixDerivative)
{
  const Vector6 q = random.six(pi), qd = random.six(2.0);
  constexpr double step = 1e-6;
  const Matrix6 change =
      (dynamics.mass_matrix(q + step * qd) - dynamics.mass_matrix(q - step * qd)) / (2.0 * step);
  EXPECT_NEAR(qd.dot(dynamics.coriolis_torques(q, qd)), 0.5 * qd.dot(change * qd), 1e-4);
}

TEST_P(DynamicsOfEveryModelTest, EnergyGainEqualsTheWorkOfTheJoints)
{
  const Vector6 middle = random.six(2.0), amplitude = random.six(0.5);
  const auto position = [&](double t) -> Vector6 { return middle + amplitude * std::sin(2.0 * t); };
  const auto velocity = [&](double t) -> Vector6 { return 2.0 * amplitude * std::cos(2.0 * t); };
  const auto energy = [&](double t) {
    return dynamics.kinetic_energy(position(t), velocity(t)) + dynamics.potential_energy(position(t));
  };
  double work = 0.0;
  constexpr double step = 1e-4;
  for (double t = 0.5 * step; t < 1.0; t += step) {
    const Vector6 acceleration = -4.0 * amplitude * std::sin(2.0 * t);
    work += step * velocity(t).dot(dynamics.inverse_dynamics(position(t), velocity(t), acceleration));
  }
  EXPECT_NEAR(work, energy(1.0) - energy(0.0), 1e-4);
}

TEST_P(DynamicsOfEveryModelTest, HoldsItselfAndItsRatedPayload)
{
  Payload rated;
  rated.mass = model.payload_max;
  dynamics.set_payload(rated);
  const Vector6 torques = dynamics.gravity_torques(default_position(model));
  EXPECT_TRUE((torques.cwiseAbs().array() <= model.torque_max.array()).all()) << torques.transpose();
}

INSTANTIATE_TEST_SUITE_P(Dynamics, DynamicsOfEveryModelTest,
                         ::testing::Values("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e",
                                           "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30"),
                         [](const auto & tested) { return std::string(tested.param); });

TEST(DynamicsTest, PayloadActsAsAForceAtItsCenterOfGravity)
{
  const RobotModel & model = model_named("ur10e");
  Dynamics without(model), with(model);
  Payload payload;
  payload.mass = 3.0;
  payload.center_of_gravity = Vector3(0.1, 0.0, 0.2);
  with.set_payload(payload);
  const Vector6 q = default_position(model);
  Vector6 at_center = Vector6::Zero();
  at_center.head<3>() = payload.center_of_gravity;
  Vector6 weight = Vector6::Zero();
  weight[2] = -3.0 * 9.82;
  const Vector6 expected = -jacobian(model, q, at_center).transpose() * weight;
  EXPECT_LT((with.gravity_torques(q) - without.gravity_torques(q) - expected).norm(), 1e-9);
}

TEST(DynamicsTest, WallMountedArmHasGravityTorqueAtTheBase)
{
  const RobotModel & model = model_named("ur5e");
  Dynamics upright(model), on_wall(model);
  on_wall.set_gravity(Vector3(9.82, 0.0, 0.0));
  Vector6 q = Vector6::Zero();
  q[0] = pi / 2.0;
  EXPECT_NEAR(upright.gravity_torques(q)[0], 0.0, 1e-9);
  EXPECT_GT(std::abs(on_wall.gravity_torques(q)[0]), 1.0);
}

TEST(DynamicsTest, CurrentsAreTorquesDividedByTheTorqueConstant)
{
  const RobotModel & model = model_named("ur10e");
  const Dynamics dynamics(model);
  EXPECT_LT((dynamics.currents(model.torque_constant) - Vector6::Ones()).norm(), 1e-12);
}

}  // namespace
}  // namespace ur_simulator
