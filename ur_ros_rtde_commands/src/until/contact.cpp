#include "contact.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>

#include "queries/query_command.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
/// Time beyond the timeout of the goal, for the stop, the retraction, and a slow clock of the controller.
constexpr std::chrono::seconds script_reserve{60};
constexpr std::string_view joints_marker = "ur_ros_rtde: contact at ";
constexpr std::string_view pose_marker = "ur_ros_rtde: contact pose ";
constexpr std::string_view timeout_marker = "ur_ros_rtde: no contact in time";

/// Each iteration takes one control cycle, in speedl.
constexpr std::string_view search_script = R"(begin = get_actual_tcp_pose()
steps = 0
way = 0
time = 0
while steps <= 0 and way < {distance} and time < {timeout}:
  speedl([{twist}], a={acceleration}, t=get_steptime())
  steps = tool_contact(direction=[{direction}, 0, 0, 0])
  way = point_dist(begin, get_actual_tcp_pose())
  time = time + get_steptime()
end
if steps > 0:
  q = get_actual_joint_positions_history(steps)
  stopl({deceleration})
  textmsg("{joints_marker}", q)
  textmsg("{pose_marker}", get_forward_kin(q))
  if {retract}:
    movel(q, a=0.5, v=0.05)
  end
else:
  stopl({deceleration})
  if time >= {timeout}:
    textmsg("{timeout_marker}")
  end
end
)";
/// m/s^2, as in the contact detection of ur_rtde.
constexpr double contact_deceleration = 3.0;

std::string contact_program(const ContactMotion & motion)
{
  const auto & d = motion.direction;
  const bool has_direction = d.x != 0.0 || d.y != 0.0 || d.z != 0.0;
  const auto & direction = has_direction ? d : motion.twist.linear;
  return fmt::format(
      fmt::runtime(search_script), fmt::arg("distance", motion.distance), fmt::arg("timeout", motion.timeout),
      fmt::arg("twist", fmt::join(to_ur(motion.twist), ", ")), fmt::arg("acceleration", motion.acceleration),
      fmt::arg("direction", fmt::format("{}, {}, {}", direction.x, direction.y, direction.z)),
      fmt::arg("deceleration", contact_deceleration), fmt::arg("retract", motion.retract ? "True" : "False"),
      fmt::arg("joints_marker", joints_marker), fmt::arg("pose_marker", pose_marker),
      fmt::arg("timeout_marker", timeout_marker));
}

/// The list or pose after `marker` in a text message: "… [1, 2, 3, 4, 5, 6]".
std::optional<Vector6> parse_vector6(std::string_view marker, const std::string & text)
{
  const auto bracket = text.find('[');
  if (!text.starts_with(marker) || bracket == std::string::npos) {
    return std::nullopt;
  }
  Vector6 values;
  const char * at = text.c_str() + bracket + 1;
  for (double & value : values) {
    char * end = nullptr;
    value = std::strtod(at, &end);
    if (end == at) {
      return std::nullopt;
    }
    at = *end == ',' ? end + 1 : end;
  }
  return values;
}
}  // namespace

Check & check_direction(Check & check, const geometry_msgs::msg::Twist & direction)
{
  return check.vector("direction.linear", direction.linear, any_length)
      .vector("direction.angular", direction.angular, any_length);
}

int contact_steps(Run & run, const std::vector<double> & direction)
{
  return query(run, [&](auto & control) { return control.toolContact(direction); });
}

Outcome move_until_contact(Run & run, const ContactMotion & motion,
                           const std::function<void(const ur_ros_rtde_msgs::msg::ArmState &)> & on_contact)
{
  std::optional<Vector6> joints, pose;
  bool timed_out = false;
  const Vector6 start = run.state().actual_tcp_pose;
  ScriptOptions options;
  options.timeout = std::chrono::ceil<std::chrono::milliseconds>(
      std::chrono::duration<double>(motion.timeout) + script_reserve);
  options.on_text = [&](const std::string & text) {
    joints = joints ? joints : parse_vector6(joints_marker, text);
    pose = pose ? pose : parse_vector6(pose_marker, text);
    timed_out = timed_out || text.starts_with(timeout_marker);
  };
  const ScriptReport report = run.run_script(contact_program(motion), options);
  if (joints && pose) {
    ur_ros_rtde_msgs::msg::ArmState state;
    state.joint_positions = *joints;
    state.tcp_pose = to_ros(*pose);
    on_contact(state);
  }
  if (!report) {
    return report.error;
  }
  if (timed_out) {
    return Outcome::failure(ErrorCode::timeout, fmt::format("no contact within {} s", motion.timeout));
  }
  if (!joints || !pose) {
    const Vector6 end = run.state().actual_tcp_pose;
    return Outcome::failure(ErrorCode::not_reached,
                            fmt::format("no contact within {} m: the TCP moved {:.3f} m", motion.distance,
                                        length(end[0] - start[0], end[1] - start[1], end[2] - start[2])));
  }
  return Outcome::success();
}

}  // namespace ur_ros_rtde
