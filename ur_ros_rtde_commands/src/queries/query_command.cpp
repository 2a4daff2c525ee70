#include "queries/query_command.hpp"

#include <algorithm>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

std::array<double, 6> to_array6(const std::vector<double> & values)
{
  if (values.size() != 6) {
    throw std::runtime_error(fmt::format("expected 6 values, received {}", values.size()));
  }
  std::array<double, 6> result;
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

std::array<double, 36> to_row_major(const std::vector<double> & columns)
{
  if (columns.size() != 36) {
    throw std::runtime_error(fmt::format("expected 36 values, received {}", columns.size()));
  }
  std::array<double, 36> rows;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      rows[6 * row + column] = columns[6 * column + row];
    }
  }
  return rows;
}

geometry_msgs::msg::Pose to_pose(const std::vector<double> & pose)
{
  return to_ros(to_array6(pose));
}

std::vector<double> or_current(const std::vector<double> & values, const Vector6 & current)
{
  return values.empty() ? std::vector<double>(current.begin(), current.end()) : values;
}

std::vector<double> tcp_or_active(ur_rtde::RTDEControlInterface & control, bool given,
                                  const geometry_msgs::msg::Pose & tcp)
{
  return given ? to_ur(tcp) : control.getTCPOffset();
}

Check & check_optional_joints(Check & check, std::string_view field, const std::vector<double> & values)
{
  return values.empty() ? check : check.joints(field, values);
}

Check & check_optional_velocities(Check & check, std::string_view field, const std::vector<double> & values)
{
  Vector6 limits;
  limits.fill(10.0);
  return values.empty() ? check : check.each_joint(field, values, limits, "rad/s");
}

Check & check_optional_tcp(Check & check, bool given, const geometry_msgs::msg::Pose & tcp)
{
  return given ? check.frame("tcp", tcp) : check;
}

}  // namespace ur_ros_rtde
