#include "state/fake_joints.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ur_ros_rtde {
namespace {
/// Limit of the joints of all arms, rad.
constexpr double max_position = 2.0 * std::numbers::pi;
}  // namespace

void FakeJoints::begin(const sensor_msgs::msg::JointState & real)
{
  const std::lock_guard lock(mutex_);
  if (!active_) {
    joints_ = real;
    std::fill(joints_.velocity.begin(), joints_.velocity.end(), 0.0);
    std::fill(joints_.effort.begin(), joints_.effort.end(), 0.0);
  }
  active_ = true;
}

void FakeJoints::end()
{
  const std::lock_guard lock(mutex_);
  active_ = false;
}

bool FakeJoints::active() const
{
  const std::lock_guard lock(mutex_);
  return active_;
}

tl::expected<void, std::string> FakeJoints::set(const sensor_msgs::msg::JointState & message)
{
  const std::lock_guard lock(mutex_);
  if (!active_) {
    return tl::unexpected(std::string("publish_fake_joint_states is off"));
  }
  if (message.position.size() != message.name.size()) {
    return tl::unexpected(fmt::format("it has {} names and {} positions, it must have one position per name",
                                      message.name.size(), message.position.size()));
  }
  std::vector<double> positions = joints_.position;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    const auto found = std::find(joints_.name.begin(), joints_.name.end(), message.name[i]);
    if (found == joints_.name.end()) {
      return tl::unexpected(fmt::format("there is no joint \"{}\", the joints are: {}", message.name[i],
                                        fmt::join(joints_.name, ", ")));
    }
    if (!(std::abs(message.position[i]) <= max_position)) {
      return tl::unexpected(fmt::format("the position of {} is {} rad, it must be {:.5f} to {:.5f} rad",
                                        message.name[i], message.position[i], -max_position, max_position));
    }
    positions[static_cast<std::size_t>(found - joints_.name.begin())] = message.position[i];
  }
  joints_.position = std::move(positions);
  return {};
}

bool FakeJoints::apply(sensor_msgs::msg::JointState & shown) const
{
  const std::lock_guard lock(mutex_);
  if (!active_) {
    return false;
  }
  std::copy(joints_.position.begin(), joints_.position.end(), shown.position.begin());
  std::fill(shown.velocity.begin(), shown.velocity.end(), 0.0);
  std::fill(shown.effort.begin(), shown.effort.end(), 0.0);
  return true;
}

}  // namespace ur_ros_rtde
