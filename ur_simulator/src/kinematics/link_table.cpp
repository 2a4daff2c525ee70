#include "kinematics/link_table.hpp"

#include <map>
#include <stdexcept>
#include <string>

namespace ur_simulator {
namespace {

struct Tensor {
  double xx, xy, xz, yy, yz, zz;
};

Link link(double mass, const Vector3 & center_of_mass, const Tensor & t)
{
  Link result{mass, center_of_mass, Eigen::Matrix3d::Zero()};
  result.inertia << t.xx, t.xy, t.xz,  //
      t.xy, t.yy, t.yz,                //
      t.xz, t.yz, t.zz;
  return result;
}

// Inertia tensor of a cylinder about the named axis of the link frame, from its transverse and axial moments.
Tensor cylinder_x(double transverse, double axial)
{
  return {axial, 0, 0, transverse, 0, transverse};
}
Tensor cylinder_y(double transverse, double axial)
{
  return {transverse, 0, 0, axial, 0, transverse};
}
Tensor cylinder_z(double transverse, double axial)
{
  return {transverse, 0, 0, transverse, 0, axial};
}

using Links = std::array<Link, 6>;

// Masses and centers of mass: Universal Robots, "DH Parameters for calculations of kinematics and dynamics".
// Inertias: Universal_Robots_ROS2_Description, config/<model>/physical_parameters.yaml, converted from its
// link frames to DH frames. For the UR3 and UR5 (CB3) these are cylinders.

Links ur3()
{
  return {link(2.0, {0, -0.02, 0}, cylinder_y(0.00809317, 0.005625)),
          link(3.42, {0.13, 0, 0.1157}, cylinder_x(0.02172849, 0.00961875)),
          link(1.26, {0.05, 0, 0.0238}, cylinder_x(0.00654681, 0.00354375)),
          link(0.8, {0, 0, 0.01}, cylinder_y(0.00161064, 0.00225)),
          link(0.8, {0, 0, 0.01}, cylinder_y(0.00157217, 0.00225)),
          link(0.35, {0, 0, -0.02}, cylinder_z(0.00013627, 0.0001792))};
}

Links ur5()
{
  return {link(3.7, {0, -0.02561, 0.00193}, cylinder_y(0.01497236, 0.01040625)),
          link(8.393, {0.2125, 0, 0.11336}, cylinder_x(0.13388584, 0.0151074)),
          link(2.33, {0.15, 0, 0.0265}, cylinder_x(0.0312168, 0.004095)),
          link(1.219, {0, -0.0018, 0.01634}, cylinder_y(0.00201389, 0.0021942)),
          link(1.219, {0, 0.0018, 0.01634}, cylinder_y(0.00183104, 0.0021942)),
          link(0.1879, {0, 0, -0.001159}, cylinder_z(8.062476e-05, 0.00013211719))};
}

// The same tensors are published for the UR10, UR10e and UR12e.
Links ur10_with(const std::array<double, 6> & mass)
{
  return {link(mass[0], {0.021, 0, 0.027}, {0.03408, 0.00002, -0.00425, 0.03529, 0.00008, 0.02156}),
          link(mass[1], {0.38, 0, 0.158}, {0.02814, 0.00005, -0.01561, 0.77068, 0.00002, 0.76943}),
          link(mass[2], {0.24, 0, 0.068}, {0.01014, 0.00008, 0.00916, 0.30928, 0, 0.30646}),
          link(mass[3], {0, 0.007, 0.018}, {0.00296, -0.00001, 0, 0.00222, -0.00024, 0.00258}),
          link(mass[4], {0, 0.007, 0.018}, {0.00296, -0.00001, 0, 0.00222, -0.00024, 0.00258}),
          link(mass[5], {0, 0, -0.026}, {0.0004, 0, 0, 0.00041, 0, 0.00034})};
}

Links ur3e()
{
  return {
      link(1.98, {0, -0.02, 0}, {0.0027657, 0.0000096, -0.0000149, 0.0021501, 0.0001873, 0.0025626}),
      link(3.4445, {0.13, 0, 0.1157}, {0.0042623, -0.0000409, -0.001496, 0.0460284, -0.0000129, 0.0448947}),
      link(1.437, {0.05, 0, 0.0238}, {0.0010511, 0, -0.0000331, 0.0113396, 0.0000022, 0.0110895}),
      link(0.871, {0, 0, 0.01}, {0.0008174, -0.0000005, 0.0000021, 0.0006844, 0.0000617, 0.0005497}),
      link(0.805, {0, 0, 0.01}, {0.0006059, -0.0000006, -0.0000006, 0.0005837, -0.0000271, 0.0003831}),
      link(0.261, {0, 0, -0.02}, {0.000108, -0.0000001, -0.0000001, 0.0001086, -0.0000002, 0.0001371})};
}

Links ur5e()
{
  return {
      link(3.761, {0, -0.02561, 0.00193},
           {0.0070021, 7.3e-07, -1.053e-05, 0.00648091, 0.00049994, 0.00657286}),
      link(8.058, {0.2125, 0, 0.11336}, {0.01505885, -0.000054, 5.63e-06, 0.33388086, -1.81e-06, 0.33247207}),
      link(2.846, {0.15, 0, 0.0265}, {0.00399632, -1.365e-05, 0.00137272, 0.07879254, -6.6e-06, 0.0784851}),
      link(1.37, {0, -0.0018, 0.01634},
           {0.00165491, -2.82e-06, -4.38e-06, 0.00135962, 0.00010157, 0.00126279}),
      link(1.3, {0, 0.0018, 0.01634}, {0.00135617, -2.74e-06, 4.44e-06, 0.00127827, -5.048e-05, 0.00096614}),
      link(0.365, {0, 0, -0.001159}, {0.00018694, 6e-08, -1.7e-07, 0.00018908, -9.2e-07, 0.00025756})};
}

Links ur16e()
{
  return {link(7.369, {0, -0.016, 0.03}, {0.03351, 0.00002, -0.00001, 0.03374, 0.00374, 0.021}),
          link(10.45, {0.302, 0, 0.16}, {0.02796, -0.0001, -0.0072, 0.47558, 0.00003, 0.47635}),
          link(4.321, {0.194, 0, 0.065}, {0.01091, 0.00006, 0.01012, 0.1206, 0.00001, 0.11714}),
          link(2.18, {0, -0.009, 0.011}, {0.00609, -0.00001, 0, 0.00245, 0.00083, 0.00579}),
          link(2.033, {0, 0.018, 0.012}, {0.00389, -0.00001, 0, 0.00219, -0.00045, 0.00363}),
          link(0.907, {0, 0, -0.044}, {0.00117, 0, 0, 0.00118, 0, 0.00084})};
}

// UR8 Long, UR15 and UR18 differ in upper arm and forearm only.
Links ur15_family(const Link & upper_arm, const Link & forearm)
{
  return {link(9.9883, {0.000024, -0.033309, 0.025304},
               {0.051334, 0.000025, -0.000016, 0.047702, 0.008805, 0.034263}),
          upper_arm,
          forearm,
          link(2.089, {0.000025, -0.019695, 0.016413},
               {0.004339, 0.000019, 0.000001, 0.002548, 0.000706, 0.003912}),
          link(2.0869, {0.000025, 0.01996, 0.015886},
               {0.004288, 0.000017, -0.000003, 0.002566, -0.000716, 0.003927}),
          link(1.0666, {-0.000018, -0.000112, -0.053397},
               {0.001406, -0.000003, 0.00001, 0.001404, -0.000024, 0.001002})};
}

Links ur8long()
{
  return ur15_family(link(17.0738, {0.565429, -0.000074, 0.19542},
                          {0.056709, 0.000292, -0.054852, 2.44012, -0.000014, 2.432744}),
                     link(7.6393, {0.416102, 0.000058, 0.065663},
                          {0.022148, 0.000052, 0.019779, 0.633274, 0.000003, 0.625889}));
}

Links ur15()
{
  return ur15_family(link(14.9255, {0.419009, -0.000083, 0.192787},
                          {0.048202, 0.000232, -0.032135, 1.188499, -0.000017, 1.182771}),
                     link(6.1015, {0.305471, 0.000019, 0.070552},
                          {0.018481, -0.000005, 0.013601, 0.303502, 0.000003, 0.296843}));
}

Links ur18()
{
  return ur15_family(
      link(14.2009, {0.308664, -0.000088, 0.190204},
           {0.045094, 0.000179, -0.024705, 0.630805, -0.00002, 0.625724}),
      link(5.52, {0.199652, 0.000021, 0.073101}, {0.016891, 0, 0.009081, 0.129732, 0.000003, 0.123451}));
}

Links ur20()
{
  return {link(16.343, {0, -0.061, 0.0062}, {0.08866, -0.00011, -0.00011, 0.07632, 0.0072, 0.08418}),
          link(29.632, {0.5226, 0, 0.2098}, {0.1467, 0.00019, -0.05163, 4.6659, 0.00004, 4.6348}),
          link(7.879, {0.3234, 0, 0.0604}, {0.02612, -0.00005, -0.02898, 0.75763, -0.00001, 0.75327}),
          link(3.054, {0, -0.0026, 0.0393}, {0.00555, -0.00001, -0.00002, 0.00537, 0.00036, 0.00402}),
          link(3.126, {0, 0.0024, 0.0379}, {0.00586, -0.00001, 0.00002, 0.00578, -0.00037, 0.00427}),
          link(0.926, {0, -0.0003, -0.0293}, {0.00092, 0, 0, 0.00091, 0, 0.00117})};
}

// The UR30 shares its joints with the UR20. No usable tensors of its upper arm and forearm were found: those
// of the UR20, scaled by mass along the link and by mass times length squared across it.
Links ur30()
{
  Links links = ur20();
  links[0].center_of_mass = {-0.0001, -0.06, 0.0069};
  links[1] = link(28.542, {0.3894, 0, 0.2103}, {0.1413, 0, 0, 2.4543, 0, 2.438});
  links[2] = link(7.156, {0.2257, 0, 0.0629}, {0.02372, 0, 0, 0.32877, 0, 0.32688});
  links[3].center_of_mass = {0, -0.0048, 0.0353};
  links[4].center_of_mass = {0, 0.0046, 0.0341};
  return links;
}

std::map<std::string, Links, std::less<>> all_links()
{
  const Links ur10e = ur10_with({7.369, 13.051, 3.989, 2.1, 1.98, 0.615});
  return {{"ur3", ur3()},         {"ur5", ur5()},   {"ur10", ur10_with({7.1, 12.7, 4.27, 2.0, 2.0, 0.365})},
          {"ur3e", ur3e()},       {"ur5e", ur5e()}, {"ur7e", ur5e()},
          {"ur10e", ur10e},       {"ur12e", ur10e}, {"ur16e", ur16e()},
          {"ur8long", ur8long()}, {"ur15", ur15()}, {"ur18", ur18()},
          {"ur20", ur20()},       {"ur30", ur30()}};
}

}  // namespace

const std::array<Link, 6> & model_links(std::string_view model)
{
  static const auto table = all_links();
  const auto found = table.find(model);
  if (found == table.end()) {
    throw std::invalid_argument("no links known of robot model " + std::string(model));
  }
  return found->second;
}

}  // namespace ur_simulator
