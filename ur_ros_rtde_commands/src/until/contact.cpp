#include "contact.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace ur_ros_rtde {
namespace {
/// Beside the time that the goal gives: stop, way back, and a controller that runs slower than this clock.
constexpr std::chrono::seconds reserve{60};
constexpr std::string_view joints_mark = "ur_ros_rtde: contact at ";
constexpr std::string_view pose_mark = "ur_ros_rtde: contact pose ";
constexpr std::string_view time_mark = "ur_ros_rtde: no contact in time";

/// One turn of the loop is one control cycle, which speedl takes.
constexpr std::string_view search = R"(begin = get_actual_tcp_pose()
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
  textmsg("{joints_mark}", q)
  textmsg("{pose_mark}", get_forward_kin(q))
  if {retract}:
    movel(q, a=0.5, v=0.05)
  end
else:
  stopl({deceleration})
  if time >= {timeout}:
    textmsg("{time_mark}")
  end
end
)";
/// m/s^2: quick, as one is in contact; that of ur_rtde's own contact detection.
constexpr double deceleration = 3.0;

std::string program(const ContactMotion & motion)
{
  const auto & d = motion.direction;
  const bool given = d.x != 0.0 || d.y != 0.0 || d.z != 0.0;
  const auto & way = given ? d : motion.twist.linear;
  return fmt::format(
      fmt::runtime(search), fmt::arg("distance", motion.distance), fmt::arg("timeout", motion.timeout),
      fmt::arg("twist", fmt::join(to_ur(motion.twist), ", ")), fmt::arg("acceleration", motion.acceleration),
      fmt::arg("direction", fmt::format("{}, {}, {}", way.x, way.y, way.z)),
      fmt::arg("deceleration", deceleration), fmt::arg("retract", motion.retract ? "True" : "False"),
      fmt::arg("joints_mark", joints_mark), fmt::arg("pose_mark", pose_mark),
      fmt::arg("time_mark", time_mark));
}

/// The list or pose that follows `mark` in a text message: "… [1, 2, 3, 4, 5, 6]".
std::optional<Vector6> parse_vector6(std::string_view mark, const std::string & text)
{
  const auto bracket = text.find('[');
  if (!text.starts_with(mark) || bracket == std::string::npos) {
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
  const int steps = run.control()->toolContact(direction);
  // An answer that did not come reads as 0.
  if (const Status possible = run.robot().motion_possible(); !possible) {
    throw RobotError(possible.error());
  }
  return steps;
}

Outcome move_until_contact(Run & run, const ContactMotion & motion,
                           const std::function<void(const ur_ros_rtde_msgs::msg::ArmState &)> & found)
{
  std::optional<Vector6> joints, pose;
  bool timed_out = false;
  const Vector6 start = run.state().actual_tcp_pose;
  ScriptOptions options;
  options.limit =
      std::chrono::ceil<std::chrono::milliseconds>(std::chrono::duration<double>(motion.timeout) + reserve);
  options.on_text = [&](const std::string & text) {
    joints = joints ? joints : parse_vector6(joints_mark, text);
    pose = pose ? pose : parse_vector6(pose_mark, text);
    timed_out = timed_out || text.starts_with(time_mark);
  };
  const ScriptReport report = run.run_script(program(motion), options);
  if (joints && pose) {
    ur_ros_rtde_msgs::msg::ArmState state;
    state.joint_positions = *joints;
    state.tcp_pose = to_ros(*pose);
    found(state);
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
                            fmt::format("no contact within {} m: the TCP went {:.3f} m", motion.distance,
                                        std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2])));
  }
  return Outcome::success();
}

}  // namespace ur_ros_rtde
