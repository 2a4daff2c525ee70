#include "kinematics/robot_model.hpp"

#include <fmt/format.h>

#include <cctype>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "kinematics/link_table.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;

/// Published parameters of a model: DH lengths (m), joint speed limits (deg/s), joint torques (N m), rated
/// payload (kg), reach (m). Lengths: Universal Robots, "DH Parameters for calculations of kinematics and
/// dynamics". Limits: Universal_Robots_ROS2_Description, config/<model>/joint_limits.yaml (from UR's user
/// manuals and "Max. joint torques"); the UR8 Long and UR15 are assumed to have the limits of the UR18, which
/// has the same joints. Offsets of the tubes (m): ur_description; UR8 Long, UR15 and UR18: estimated from the
/// centers of mass.
struct ModelParameters {
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
  double upper_arm_offset;
  double forearm_offset;
};

using JointValues = std::array<double, 6>;
constexpr JointValues speed_ur5{180, 180, 180, 180, 180, 180};
constexpr JointValues speed_ur3{180, 180, 180, 360, 360, 360};
constexpr JointValues speed_ur10{120, 120, 180, 180, 180, 180};
constexpr JointValues speed_ur15{180, 180, 240, 300, 300, 300};
constexpr JointValues speed_ur20{120, 120, 150, 210, 210, 210};
constexpr JointValues torque3{56, 56, 28, 12, 12, 12};
constexpr JointValues torque3e{54, 54, 28, 9, 9, 9};
constexpr JointValues torque5{150, 150, 150, 28, 28, 28};
constexpr JointValues torque10{330, 330, 150, 56, 56, 56};
constexpr JointValues torque10e{330, 330, 150, 54, 54, 54};
constexpr JointValues torque15{433, 433, 204, 70, 70, 70};
constexpr JointValues torque20{738, 738, 433, 107, 107, 107};

// Type numbers of the robot mode and version messages of the primary interface (ur_client_library,
// RobotType).
constexpr std::array<ModelParameters, 14> model_parameters{{
    {"ur3", "UR3", "UR3", 3, Series::cb3, 0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819, speed_ur3,
     torque3, 3, 0.5, 0.1198, 0.0275},
    {"ur5", "UR5", "UR5", 1, Series::cb3, 0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823, speed_ur5,
     torque5, 5, 0.85, 0.13585, 0.0165},
    {"ur10", "UR10", "UR10", 2, Series::cb3, 0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922, speed_ur10,
     torque10, 10, 1.3, 0.220941, 0.049042},
    {"ur3e", "UR3e", "UR3", 3, Series::e_series, 0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921,
     speed_ur3, torque3e, 3, 0.5, 0.12, 0.027},
    {"ur5e", "UR5e", "UR5", 1, Series::e_series, 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996, speed_ur5,
     torque5, 5, 0.85, 0.138, 0.007},
    {"ur7e", "UR7e", "UR5", 1, Series::e_series, 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996, speed_ur5,
     torque5, 7.5, 0.85, 0.138, 0.007},
    {"ur10e", "UR10e", "UR10", 2, Series::e_series, 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655,
     speed_ur10, torque10e, 12.5, 1.3, 0.1762, 0.0393},
    {"ur12e", "UR12e", "UR10", 2, Series::e_series, 0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655,
     speed_ur10, torque10e, 12.5, 1.3, 0.1762, 0.0393},
    {"ur16e", "UR16e", "UR16", 4, Series::e_series, 0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655,
     speed_ur10, torque10e, 16, 0.9, 0.176, 0.04},
    {"ur8long", "UR8 Long", "UR8LONG", 6, Series::ur_series, 0.2186, -0.8989, -0.7149, 0.1824, 0.1361, 0.1434,
     speed_ur15, torque15, 10, 1.75, 0.195, 0.066},
    {"ur15", "UR15", "UR15", 9, Series::ur_series, 0.2186, -0.6475, -0.5164, 0.1824, 0.1361, 0.1434,
     speed_ur15, torque15, 17.5, 1.3, 0.195, 0.066},
    {"ur18", "UR18", "UR18", 5, Series::ur_series, 0.2186, -0.475, -0.3389, 0.1824, 0.1361, 0.1434,
     speed_ur15, torque15, 18, 0.95, 0.195, 0.066},
    {"ur20", "UR20", "UR20", 7, Series::ur_series, 0.2363, -0.862, -0.7287, 0.201, 0.1593, 0.1543, speed_ur20,
     torque20, 25, 1.75, 0.26, 0.043},
    {"ur30", "UR30", "UR30", 8, Series::ur_series, 0.2363, -0.637, -0.5037, 0.201, 0.1593, 0.1543, speed_ur20,
     torque20, 35, 1.3, 0.26, 0.043},
}};

/// N m/A at the joint, after the gear. Not published by UR; estimates by joint size, of the order that
/// identifications of UR arms report (about 10 to 15).
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

/// Radius of the housing of a joint, m: estimates from UR's drawings, by the torque, which identifies the
/// size.
double joint_radius(double torque_max)
{
  static const std::map<double, double> radii{{9, 0.0315},  {12, 0.0315}, {28, 0.0375},  {54, 0.045},
                                              {56, 0.045},  {70, 0.049},  {107, 0.0575}, {150, 0.058},
                                              {204, 0.064}, {330, 0.075}, {433, 0.08},   {738, 0.098}};
  return radii.at(torque_max);
}

RobotModel build(const ModelParameters & parameters)
{
  RobotModel model{};
  model.name = parameters.name;
  model.display_name = parameters.display_name;
  model.dashboard_name = parameters.dashboard_name;
  model.type_number = parameters.type_number;
  model.series = parameters.series;
  model.a << 0.0, parameters.a2, parameters.a3, 0.0, 0.0, 0.0;
  model.d << parameters.d1, 0.0, 0.0, parameters.d4, parameters.d5, parameters.d6;
  model.alpha << pi / 2.0, 0.0, 0.0, pi / 2.0, -pi / 2.0, 0.0;
  model.theta.setZero();
  model.links = model_links(parameters.name);
  model.position_min.setConstant(-2.0 * pi);
  model.position_max.setConstant(2.0 * pi);
  if (parameters.payload == 3.0) {  // wrist 3 of the UR3 and UR3e is continuous
    model.position_min[5] = -std::numeric_limits<double>::infinity();
    model.position_max[5] = std::numeric_limits<double>::infinity();
  }
  model.velocity_max = Eigen::Map<const Vector6>(parameters.speed.data()) * (pi / 180.0);
  // Not published. 40 rad/s^2 is the highest value that ur_rtde accepts (UR_JOINT_ACCELERATION_MAX).
  model.acceleration_max.setConstant(40.0);
  model.torque_max = Eigen::Map<const Vector6>(parameters.torque.data());
  // Not published. 10 mrad at the highest torque gives about 30 N/mm at the tool of a UR10e, as measured on
  // similar arms.
  model.stiffness = 100.0 * model.torque_max;
  model.torque_constant = model.torque_max.unaryExpr(&torque_constant);
  model.joint_radius = model.torque_max.unaryExpr(&joint_radius);
  model.upper_arm_offset = parameters.upper_arm_offset;
  model.forearm_offset = parameters.forearm_offset;
  model.payload_max = parameters.payload;
  model.reach = parameters.reach;
  return model;
}

const std::vector<RobotModel> & model_table()
{
  static const std::vector<RobotModel> models = [] {
    std::vector<RobotModel> built;
    for (const ModelParameters & parameters : model_parameters) {
      built.push_back(build(parameters));
    }
    return built;
  }();
  return models;
}

std::string normalize_name(std::string_view name)
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
  return model_table();
}

tl::expected<std::reference_wrapper<const RobotModel>, std::string> find_robot_model(std::string_view name)
{
  const std::string normalized = normalize_name(name);
  std::string known;
  for (const RobotModel & model : model_table()) {
    if (model.name == normalized) {
      return std::cref(model);
    }
    known += (known.empty() ? "" : ", ") + model.name;
  }
  return tl::unexpected(fmt::format("unknown robot model '{}'; known are {}", name, known));
}

Vector6 default_position(const RobotModel &)
{
  Vector6 position;
  position << 0.0, -1.57, 1.57, -1.57, -1.57, 0.0;
  return position;
}

}  // namespace ur_simulator
