#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/contact_detection.hpp>

#include "contact.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
/// A query occupies the control program for three cycles, in which it executes no other command.
constexpr std::chrono::milliseconds query_interval{20};

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

/// The direction of the goal, or the current direction of the TCP if it is zero.
std::vector<double> contact_direction(const std::vector<double> & direction, const Sample & sample)
{
  const Vector6 & motion = sample.target_tcp_speed;
  return is_zero(direction) ? std::vector<double>(motion.begin(), motion.end()) : direction;
}

double seconds(std::chrono::nanoseconds duration)
{
  return std::chrono::duration<double>(duration).count();
}

Outcome wait_for_contact(const std::function<bool()> & in_contact, double timeout, Run & run)
{
  while (!in_contact()) {
    if (seconds(run.elapsed()) > timeout) {
      return Outcome::failure(ErrorCode::timeout, fmt::format("no contact within {} s", timeout));
    }
    if (auto stop_reason = run.sleep_for(query_interval)) {
      return *stop_reason;
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
        .polyscope(min_contact_polyscope)
        .answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto in_contact = [&] {
      run.feedback().elapsed = to_ros(run.elapsed());
      run.publish();
      return contact_steps(run, contact_direction(to_ur(goal.direction), run.state())) > 0;
    };
    const Outcome outcome = wait_for_contact(in_contact, goal.timeout, run);
    run.result().after = seconds(run.elapsed());
    return outcome;
  }
};

UR_ROS_RTDE_EXPORT(ContactDetection, "contact_detection")

}  // namespace ur_ros_rtde
