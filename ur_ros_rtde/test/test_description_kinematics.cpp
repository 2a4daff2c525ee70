#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "state/description_kinematics.hpp"
#include "ur_ros_rtde/check.hpp"

namespace ur_ros_rtde {
namespace {

kinematics::DhRows nominal_rows()
{
  return kinematics::dh_rows(
      {.d1 = 0.1625, .a2 = -0.425, .a3 = -0.3922, .d4 = 0.1333, .d5 = 0.0997, .d6 = 0.0996});
}

/// A URDF of these rows. The rotation of joint i follows Tx(a) Rx(alpha) of row i-1 and Tz(d) of its own row.
std::string urdf_of(const kinematics::DhRows & rows, const std::string & prefix = "")
{
  std::string text = "<robot name=\"arm\"><link name=\"base\"/>";
  std::string parent = "base";
  kinematics::DhRow before{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string joint = prefix + joint_names()[i];
    const double d = rows[i].d;
    text += fmt::format(
        "<joint name=\"{}\" type=\"revolute\"><parent link=\"{}\"/><child link=\"{}_link\"/>"
        "<origin xyz=\"{:.12f} {:.12f} {:.12f}\" rpy=\"{:.12f} 0 0\"/><axis xyz=\"0 0 1\"/></joint>",
        joint, parent, joint, before.a, -std::sin(before.alpha) * d, std::cos(before.alpha) * d,
        before.alpha);
    parent = joint + "_link";
    before = rows[i];
  }
  return text + "</robot>";
}

std::string replaced(std::string text, const std::string & from, const std::string & to)
{
  const auto position = text.find(from);
  EXPECT_NE(position, std::string::npos) << from;
  return text.replace(position, from.size(), to);
}

TEST(DescriptionKinematicsTest, AgreesWithTheSameArm)
{
  const auto description = read_description(urdf_of(nominal_rows(), "left_"), "left_");
  ASSERT_TRUE(description);
  const auto deviation = compare_kinematics(*description, nominal_rows());
  EXPECT_LT(deviation.distance, 1e-9);
  EXPECT_LT(deviation.angle, 1e-9);
  EXPECT_TRUE(deviation.is_negligible());
}

TEST(DescriptionKinematicsTest, FindsEachDeviatingParameter)
{
  const auto description = read_description(urdf_of(nominal_rows()), "");
  ASSERT_TRUE(description);
  for (std::size_t joint = 0; joint < 6; ++joint) {
    for (double kinematics::DhRow::* parameter : {&kinematics::DhRow::theta, &kinematics::DhRow::a,
                                                  &kinematics::DhRow::d, &kinematics::DhRow::alpha}) {
      auto rows = nominal_rows();
      rows[joint].*parameter += 1e-3;
      const auto deviation = compare_kinematics(*description, rows);
      // Theta of the base turns the flange about a distant axis, so that the distance may be larger.
      EXPECT_FALSE(deviation.is_negligible()) << joint;
      EXPECT_GT(std::max(deviation.distance, deviation.angle), 0.9e-3) << joint;
    }
  }
}

TEST(DescriptionKinematicsTest, IgnoresWhatIsNoArm)
{
  const std::string urdf = urdf_of(nominal_rows());
  EXPECT_FALSE(read_description("", ""));
  EXPECT_FALSE(read_description("<robot", ""));
  EXPECT_FALSE(read_description("<model/>", ""));
  EXPECT_FALSE(read_description("<robot name=\"table\"/>", ""));
  EXPECT_FALSE(read_description(urdf, "right_"));
  EXPECT_FALSE(read_description(replaced(urdf, "name=\"elbow_joint\"", "name=\"knee_joint\""), ""));
  EXPECT_FALSE(
      read_description(replaced(urdf, "parent link=\"elbow_joint_link\"", "parent link=\"base\""), ""));
  EXPECT_FALSE(read_description(replaced(urdf, "xyz=\"0 0 1\"", "xyz=\"0 1 0\""), ""));
  EXPECT_FALSE(read_description(replaced(urdf, "0.162500000000", "nan"), ""));
  EXPECT_FALSE(read_description(replaced(urdf, "rpy=\"0.000000000000 0 0\"", "rpy=\"0 0\""), ""));
}

}  // namespace
}  // namespace ur_ros_rtde
