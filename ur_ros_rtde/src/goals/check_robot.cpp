#include <fmt/format.h>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_frame_distance = 100.0;  // m: larger than any cell, small enough for precise arithmetic
}

Check & Check::frame(std::string_view field, const geometry_msgs::msg::Pose & frame)
{
  geometry_msgs::msg::Vector3 position;
  position.x = frame.position.x;
  position.y = frame.position.y;
  position.z = frame.position.z;
  geometry_msgs::msg::Pose orientation = frame;
  orientation.position = geometry_msgs::msg::Point();
  return vector(fmt::format("{}.position", field), position, max_frame_distance, "m")
      .pose(field, orientation);
}

Check & Check::polyscope(unsigned minor, std::optional<unsigned> cb3_minor)
{
  if (!ready().ok() || robot_ == nullptr) {
    return *this;
  }
  const auto version = robot_->version();
  if (!version) {
    return that(false, "the version of PolyScope is not known yet: try again", ErrorCode::not_ready);
  }
  const bool enough = version->cb3() ? cb3_minor && version->minor >= *cb3_minor
                                     : version->major > 5 || version->minor >= minor;
  return that(enough,
              fmt::format("this needs PolyScope 5.{}{} or later, the robot has {}", minor,
                          cb3_minor ? fmt::format(" (CB3: 3.{})", *cb3_minor) : "", to_string(*version)),
              ErrorCode::not_supported);
}

Check & Check::answers_queries()
{
  if (!ready().ok() || robot_ == nullptr) {
    return *this;
  }
  if (const Status possible = robot_->motion_possible(); !possible) {
    return that(false, possible.error().message, possible.error().code);
  }
  // Throws the reason if it is not available.
  [[maybe_unused]] const auto control = robot_->control_for_queries();
  const auto holder = robot_->holder(Resource::motion);
  return that(!holder || !holder->blocks_queries,
              fmt::format("{} occupies every cycle of the control program: try again when it has ended",
                          holder ? holder->owner : ""),
              ErrorCode::busy);
}

}  // namespace ur_ros_rtde
