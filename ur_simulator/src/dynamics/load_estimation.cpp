#include "dynamics/load_estimation.hpp"

#include <Eigen/QR>

namespace ur_simulator {

namespace {

constexpr Eigen::Index unknowns = 10;        // mass, moment, offset of force and torque
constexpr double singular_threshold = 1e-3;  // of the largest pivot

Eigen::Matrix3d cross_matrix(const Vector3 & v)
{
  Eigen::Matrix3d result;
  result << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return result;
}

}  // namespace

std::optional<LoadEstimate> estimate_load(const std::vector<LoadMeasurement> & measurements)
{
  const Eigen::Index rows = 6 * static_cast<Eigen::Index>(measurements.size());
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(rows, unknowns);
  Eigen::VectorXd wrenches(rows);
  Eigen::Index row = 0;
  for (const auto & [upward, wrench] : measurements) {
    equations.block<3, 1>(row, 0) = -upward;
    equations.block<3, 3>(row + 3, 1) = cross_matrix(upward);
    equations.block<6, 6>(row, 4).setIdentity();
    wrenches.segment<6>(row) = wrench;
    row += 6;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(equations);
  solver.setThreshold(singular_threshold);
  if (solver.rank() < unknowns) {
    return std::nullopt;
  }
  const Eigen::VectorXd solution = solver.solve(wrenches);
  return LoadEstimate{solution[0], solution.segment<3>(1)};
}

}  // namespace ur_simulator
