#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/contact_detection.hpp>

#include "contact.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
/// Each question takes the control program three of its cycles, in which it takes no other command.
constexpr std::chrono::milliseconds question_interval{20};

builtin_interfaces::msg::Duration to_ros(std::chrono::nanoseconds duration)
{
  const auto whole = std::chrono::floor<std::chrono::seconds>(duration);
  builtin_interfaces::msg::Duration message;
  message.sec = static_cast<std::int32_t>(whole.count());
  message.nanosec = static_cast<std::uint32_t>((duration - whole).count());
  return message;
}

bool is_zero(const std::vector<double> & direction)
{
  return direction[0] == 0.0 && direction[1] == 0.0 && direction[2] == 0.0;
}

/// As the goal gives it, or where the TCP is to go now.
std::vector<double> direction_now(const std::vector<double> & given, const Sample & sample)
{
  const Vector6 & motion = sample.target_tcp_speed;
  return is_zero(given) ? std::vector<double>(motion.begin(), motion.end()) : given;
}

double seconds(std::chrono::nanoseconds duration)
{
  return std::chrono::duration<double>(duration).count();
}

Outcome ask_until(const std::function<bool()> & touches, double timeout, Run & run)
{
  while (!touches()) {
    if (seconds(run.elapsed()) > timeout) {
      return Outcome::failure(ErrorCode::timeout, fmt::format("no contact within {} s", timeout));
    }
    if (auto why = run.sleep_for(question_interval)) {
      return *why;
    }
  }
  return Outcome::success();
}
}  // namespace

class ContactDetection : public Command<ur_ros_rtde_msgs::action::ContactDetection> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_direction(check, goal.direction)
        .above_zero("timeout", goal.timeout, 86400.0, "s")
        .polyscope(contact_polyscope)
        .answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto touches = [&] {
      run.feedback().elapsed = to_ros(run.elapsed());
      run.publish();
      return contact_steps(run, direction_now(to_ur(goal.direction), run.state())) > 0;
    };
    const Outcome outcome = ask_until(touches, goal.timeout, run);
    run.result().after = seconds(run.elapsed());
    return outcome;
  }
};

UR_ROS_RTDE_EXPORT(ContactDetection, "contact_detection")

}  // namespace ur_ros_rtde
