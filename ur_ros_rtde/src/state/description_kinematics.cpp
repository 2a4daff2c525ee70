#include "state/description_kinematics.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde {
namespace {

Eigen::Vector3d read_vector(const tinyxml2::XMLElement * element, const char * name,
                            const Eigen::Vector3d & otherwise)
{
  const char * text = element == nullptr ? nullptr : element->Attribute(name);
  if (text == nullptr) {
    return otherwise;
  }
  std::istringstream numbers(text);
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    numbers >> vector[i];
  }
  return numbers ? vector : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Eigen::Isometry3d read_origin(const tinyxml2::XMLElement & joint)
{
  const auto * origin = joint.FirstChildElement("origin");
  const Eigen::Vector3d rpy = read_vector(origin, "rpy", Eigen::Vector3d::Zero());
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = (AngleAxisd(rpy[2], Vector3d::UnitZ()) * AngleAxisd(rpy[1], Vector3d::UnitY()) *
                     AngleAxisd(rpy[0], Vector3d::UnitX()))
                        .toRotationMatrix();
  result.translation() = read_vector(origin, "xyz", Vector3d::Zero());
  return result;
}

/// The name of a link of the joint: `kind` is "parent" or "child".
std::string link_of(const tinyxml2::XMLElement & joint, const char * kind)
{
  const auto * element = joint.FirstChildElement(kind);
  const char * link = element == nullptr ? nullptr : element->Attribute("link");
  return link == nullptr ? "" : link;
}

/// The rotation is about z, as in ur_description. The default of URDF is x.
bool turns_about_z(const tinyxml2::XMLElement & joint)
{
  const auto axis = read_vector(joint.FirstChildElement("axis"), "xyz", Eigen::Vector3d::UnitX());
  return (axis - Eigen::Vector3d::UnitZ()).norm() < 1e-9;
}

std::map<std::string, const tinyxml2::XMLElement *> joints_by_name(const tinyxml2::XMLElement & robot)
{
  std::map<std::string, const tinyxml2::XMLElement *> joints;
  for (const auto * joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    if (const char * name = joint->Attribute("name"); name != nullptr) {
      joints.emplace(name, joint);
    }
  }
  return joints;
}

Eigen::Isometry3d flange_pose(const JointOrigins & origins, const trajectory::Joints & q)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < origins.size(); ++i) {
    pose = pose * origins[i] * Eigen::AngleAxisd(q[static_cast<Eigen::Index>(i)], Eigen::Vector3d::UnitZ());
  }
  return pose;
}

}  // namespace

std::optional<JointOrigins> read_description(const std::string & urdf, const std::string & prefix)
{
  tinyxml2::XMLDocument document;
  const auto * robot =
      document.Parse(urdf.c_str()) == tinyxml2::XML_SUCCESS ? document.FirstChildElement("robot") : nullptr;
  if (robot == nullptr) {
    return std::nullopt;
  }
  const auto joints = joints_by_name(*robot);
  JointOrigins origins;
  std::string last_link;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const auto found = joints.find(prefix + std::string(trajectory::joint_name(static_cast<int>(i))));
    if (found == joints.end() || !turns_about_z(*found->second) ||
        (i > 0 && link_of(*found->second, "parent") != last_link)) {
      return std::nullopt;
    }
    origins[i] = read_origin(*found->second);
    if (!origins[i].matrix().allFinite()) {
      return std::nullopt;
    }
    last_link = link_of(*found->second, "child");
  }
  return origins;
}

FlangeDeviation compare_kinematics(const JointOrigins & description, const kinematics::DhRows & arm)
{
  const trajectory::Joints positions[] = {{0.0, -1.6, 1.5, -1.5, -1.6, 0.0},
                                          {0.4, -0.8, 0.6, 0.3, 1.5, 1.0},
                                          {-1.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                                          {0.0, -1.6, 0.0, -1.6, 0.0, 0.0},
                                          {0.7, -2.2, -1.8, 0.9, -0.2, 2.0}};
  const kinematics::Arm real(arm);
  FlangeDeviation result;
  for (const auto & q : positions) {
    const kinematics::Twist difference = kinematics::difference(real.forward(q), flange_pose(description, q));
    result.distance = std::max(result.distance, difference.head<3>().norm());
    result.angle = std::max(result.angle, difference.tail<3>().norm());
  }
  return result;
}

}  // namespace ur_ros_rtde
