#include <fmt/format.h>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double furthest_frame = 100.0;  // m: far beyond any cell, near enough for exact arithmetic
}

Check & Check::frame(std::string_view field, const geometry_msgs::msg::Pose & frame)
{
  geometry_msgs::msg::Vector3 position;
  position.x = frame.position.x;
  position.y = frame.position.y;
  position.z = frame.position.z;
  geometry_msgs::msg::Pose turn = frame;
  turn.position = geometry_msgs::msg::Point();
  return vector(fmt::format("{}.position", field), position, furthest_frame, "m").pose(field, turn);
}

Check & Check::polyscope(unsigned minor, std::optional<unsigned> cb3_minor)
{
  if (!ready().ok() || preflight_ == nullptr) {
    return *this;
  }
  const auto version = preflight_->robot().version();
  if (!version) {
    return that(false, "the robot has not told its version yet: try again", ErrorCode::not_ready);
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
  if (!ready().ok() || preflight_ == nullptr) {
    return *this;
  }
  Robot & robot = preflight_->robot();
  if (const Status possible = robot.motion_possible(); !possible) {
    return that(false, possible.error().message, possible.error().code);
  }
  [[maybe_unused]] const auto control = robot.control();  // throws why not, for instance that a script runs
  const auto holder = robot.arbiter().holder(Resource::motion);
  constexpr std::string_view uninterrupted = "direct_torque";
  return that(!holder || !holder->owner.ends_with(uninterrupted),
              "direct_torque takes the control program's every cycle: ask when it has ended",
              ErrorCode::busy);
}

}  // namespace ur_ros_rtde
