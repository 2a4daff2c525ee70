#include "ur_ros_rtde/target_messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ur_ros_rtde/check.hpp"

namespace ur_ros_rtde {
namespace {
/// The target, or the error of the check.
Expected<StreamTarget> target_if_valid(const Check & check, const std::vector<double> & values,
                                       bool in_tool = false)
{
  if (!check.ok()) {
    return tl::unexpected(*check.error());
  }
  StreamTarget target;
  std::copy_n(values.begin(), target.values.size(), target.values.begin());
  target.in_tool_frame = in_tool;
  return target;
}

/// Whether `given` is a name of this arm, with its prefix or without one.
bool is_name(const std::string & given, std::string_view name, const std::string & prefix)
{
  return given == name ||
         (given.starts_with(prefix) && std::string_view(given).substr(prefix.size()) == name);
}

Status check_frame(const std::string & frame_id, const std::vector<std::string_view> & frames,
                   const std::string & prefix)
{
  if (std::any_of(frames.begin(), frames.end(), [&](auto name) { return is_name(frame_id, name, prefix); })) {
    return {};
  }
  return failure(ErrorCode::invalid_goal,
                 fmt::format("header.frame_id is \"{}\", it may be {}{}", frame_id, fmt::join(frames, " or "),
                             prefix.empty() ? "" : fmt::format(", also with the prefix {}", prefix)));
}
}  // namespace

Expected<StreamTarget> joint_target(const sensor_msgs::msg::JointState & message, const ArmLimits & limits,
                                    const std::string & prefix)
{
  Check check;
  check.that(message.position.size() == message.name.size(),
             fmt::format("the message has {} names and {} positions, it must have one position per name",
                         message.name.size(), message.position.size()));
  std::vector<double> positions(joint_names().size());
  for (std::size_t i = 0; i < positions.size() && check.ok(); ++i) {
    const auto named = [&](const std::string & name) { return is_name(name, joint_names()[i], prefix); };
    const auto found = std::find_if(message.name.begin(), message.name.end(), named);
    check.that(found != message.name.end(),
               fmt::format("the message has no position of {}", joint_names()[i]));
    if (!check.ok()) {
      break;
    }
    positions[i] = message.position[static_cast<std::size_t>(found - message.name.begin())];
    check.that(std::find_if(found + 1, message.name.end(), named) == message.name.end(),
               fmt::format("the message has two positions of {}", joint_names()[i]));
  }
  check.each_joint("position", positions, limits.position, "rad");
  return target_if_valid(check, positions);
}

Expected<StreamTarget> pose_target(const geometry_msgs::msg::PoseStamped & message,
                                   const std::string & prefix)
{
  if (Status known = check_frame(message.header.frame_id, {"base"}, prefix); !known) {
    return tl::unexpected(known.error());
  }
  Check check;
  check.pose("pose", message.pose);
  return target_if_valid(check, check.ok() ? to_ur(message.pose) : std::vector<double>(6));
}

Expected<StreamTarget> twist_target(const geometry_msgs::msg::TwistStamped & message,
                                    const std::string & prefix)
{
  const std::string & frame = message.header.frame_id;
  const bool in_tool = is_name(frame, "tool0_controller", prefix);
  if (Status known = check_frame(frame, {"base", "tool0_controller"}, prefix); !known) {
    return tl::unexpected(known.error());
  }
  const std::vector<double> values = to_ur(message.twist);
  Check check;
  if (std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; })) {
    check.twist("twist", message.twist);
  }
  return target_if_valid(check, values, in_tool);
}

}  // namespace ur_ros_rtde
