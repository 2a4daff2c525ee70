#include "kinematics/robot_model.hpp"

#include <fmt/format.h>

#include <cctype>
#include <limits>
#include <numbers>
#include <vector>

#include "kinematics/link_table.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

/// What differs from model to model and is published: DH lengths (m), joint speed limits (deg/s), joint
/// torques (N m), rated payload (kg), reach (m). Lengths: Universal Robots, "DH Parameters for calculations
/// of kinematics and dynamics". Limits: Universal_Robots_ROS2_Description, config/<model>/joint_limits.yaml
/// (from UR's user manuals and "Max. joint torques"); those of UR8 Long and UR15 are taken to be the UR18's,
/// which has the same joints.
struct Row {
  const char * name;
  const char * display_name;
  const char * dashboard_name;
  std::uint8_t type_number;
  Series series;
  double d1, a2, a3, d4, d5, d6;
  std::array<double, 6> speed;
  std::array<double, 6> torque;
  double payload;
  double reach;
};

using Six = std::array<double, 6>;
constexpr Six all180{180, 180, 180, 180, 180, 180};
constexpr Six small{180, 180, 180, 360, 360, 360};
constexpr Six big{120, 120, 180, 180, 180, 180};
constexpr Six fast{180, 180, 240, 300, 300, 300};
constexpr Six heavy{120, 120, 150, 210, 210, 210};
constexpr Six torque3{56, 56, 28, 12, 12, 12};
constexpr Six torque5{150, 150, 150, 28, 28, 28};
constexpr Six torque10{330, 330, 150, 56, 56, 56};
constexpr Six torque10e{330, 330, 150, 54, 54, 54};
constexpr Six torque15{433, 433, 204, 70, 70, 70};
constexpr Six torque20{738, 738, 433, 107, 107, 107};

// Type numbers as in the primary interface's robot mode and version messages (ur_client_library, RobotType).
constexpr std::array<Row, 14> rows{{
    {"ur3", "UR3", "UR3", 3, Series::cb3, 0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819, small,
     torque3, 3, 0.5},
    {"ur5", "UR5", "UR5", 1, Series::cb3, 0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823, all180,
     torque5, 5, 0.85},
    {"ur10", "UR10", "UR10", 2, Series::cb3, 0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922, big, torque10,
     10, 1.3},
    {"ur3e", "UR3e", "UR3", 3, Series::e_series, 0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921, small,
     torque3, 3, 0.5},
    {"ur5e", "UR5e", "UR5", 1, Series::e_series, 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996, all180,
     torque5, 5, 0.85},
    {"ur7e", "UR7e", "UR5", 1, Series::e_series, 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996, all180,
     torque5, 7.5, 0.85},
    {"ur10e", "UR10e", "UR10", 2, Series::e_series, 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655, big,
     torque10e, 12.5, 1.3},
    {"ur12e", "UR12e", "UR10", 2, Series::e_series, 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655, big,
     torque10e, 12.5, 1.3},
    {"ur16e", "UR16e", "UR16", 4, Series::e_series, 0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655, big,
     torque10e, 16, 0.9},
    {"ur8long", "UR8 Long", "UR8LONG", 6, Series::ur_series, 0.2186, -0.8989, -0.7149, 0.1824, 0.1361, 0.1434,
     fast, torque15, 10, 1.75},
    {"ur15", "UR15", "UR15", 9, Series::ur_series, 0.2186, -0.6475, -0.5164, 0.1824, 0.1361, 0.1434, fast,
     torque15, 17.5, 1.3},
    {"ur18", "UR18", "UR18", 5, Series::ur_series, 0.2186, -0.475, -0.3389, 0.1824, 0.1361, 0.1434, fast,
     torque15, 18, 0.95},
    {"ur20", "UR20", "UR20", 7, Series::ur_series, 0.2363, -0.862, -0.7287, 0.201, 0.1593, 0.1543, heavy,
     torque20, 25, 1.75},
    {"ur30", "UR30", "UR30", 8, Series::ur_series, 0.2363, -0.637, -0.5037, 0.201, 0.1593, 0.1543, heavy,
     torque20, 35, 1.3},
}};

/// N m/A behind the gear. UR publishes none: of the size that identifications of UR arms report (about 10 to
/// 15), by size of joint.
double torque_constant(double torque_max)
{
  if (torque_max <= 12.0)
    return 8.0;
  if (torque_max <= 30.0)
    return 10.0;
  if (torque_max <= 110.0)
    return 11.0;
  if (torque_max <= 210.0)
    return 12.0;
  if (torque_max <= 340.0)
    return 14.0;
  return 20.0;
}

RobotModel build(const Row & row)
{
  RobotModel model{};
  model.name = row.name;
  model.display_name = row.display_name;
  model.dashboard_name = row.dashboard_name;
  model.type_number = row.type_number;
  model.series = row.series;
  model.a << 0.0, row.a2, row.a3, 0.0, 0.0, 0.0;
  model.d << row.d1, 0.0, 0.0, row.d4, row.d5, row.d6;
  model.alpha << pi / 2.0, 0.0, 0.0, pi / 2.0, -pi / 2.0, 0.0;
  model.links = links_of(row.name);
  model.position_min.setConstant(-2.0 * pi);
  model.position_max.setConstant(2.0 * pi);
  if (row.payload == 3.0) {  // wrist 3 of the UR3 and UR3e turns without end
    model.position_min[5] = -std::numeric_limits<double>::infinity();
    model.position_max[5] = std::numeric_limits<double>::infinity();
  }
  model.velocity_max = Eigen::Map<const Vector6>(row.speed.data()) * (pi / 180.0);
  // Not published; 40 rad/s^2 is the most that clients of the robot may ask for (ur_rtde,
  // UR_JOINT_ACCELERATION_MAX).
  model.acceleration_max.setConstant(40.0);
  model.torque_max = Eigen::Map<const Vector6>(row.torque.data());
  // Not published; 10 mrad at the highest torque make some 30 N/mm at the tool of a UR10e, as is measured on
  // arms of this kind.
  model.stiffness = 100.0 * model.torque_max;
  model.torque_constant = model.torque_max.unaryExpr(&torque_constant);
  model.payload_max = row.payload;
  model.reach = row.reach;
  return model;
}

const std::vector<RobotModel> & table()
{
  static const std::vector<RobotModel> models = [] {
    std::vector<RobotModel> built;
    for (const Row & row : rows) {
      built.push_back(build(row));
    }
    return built;
  }();
  return models;
}

std::string plain(std::string_view name)
{
  std::string result;
  for (const char c : name) {
    if (c != ' ' && c != '-' && c != '_') {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

}  // namespace

std::span<const RobotModel> robot_models()
{
  return table();
}

tl::expected<std::reference_wrapper<const RobotModel>, std::string> find_robot_model(std::string_view name)
{
  const std::string wanted = plain(name);
  std::string known;
  for (const RobotModel & model : table()) {
    if (model.name == wanted) {
      return std::cref(model);
    }
    known += (known.empty() ? "" : ", ") + model.name;
  }
  return tl::unexpected(fmt::format("unknown robot model '{}'; known are {}", name, known));
}

Vector6 default_position(const RobotModel &)
{
  Vector6 position;
  position << 0.0, -pi / 2.0, -pi / 2.0, -pi / 2.0, pi / 2.0, 0.0;
  return position;
}

}  // namespace ur_simulator
