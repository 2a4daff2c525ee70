#include "world/robotiq_gripper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ur_simulator {
namespace {

constexpr double release_speed = 20.0;  // mm/s
constexpr int first_major_fault = 10;   // from here on, a reset is required
constexpr int activation_required_fault = 7;
constexpr int action_delayed_fault = 5;
constexpr int release_in_progress_fault = 11;
constexpr int release_completed_fault = 15;

/// The value of a range for a register value of 0 to 255.
double scale(int value, double min, double max)
{
  return min + value / 255.0 * (max - min);
}

}  // namespace

int RobotiqGripper::Requests::* RobotiqGripper::request(std::string_view name)
{
  constexpr std::array<std::pair<std::string_view, int Requests::*>, 9> names{
      {{"ACT", &Requests::activate},
       {"MOD", &Requests::mode},
       {"GTO", &Requests::go_to},
       {"ATR", &Requests::release},
       {"ARD", &Requests::release_closes},
       {"MSC", &Requests::max_current},
       {"POS", &Requests::position},
       {"SPE", &Requests::speed},
       {"FOR", &Requests::force}}};
  const auto found = std::ranges::find(names, name, [](const auto & entry) { return entry.first; });
  return found == names.end() ? nullptr : found->second;
}

bool RobotiqGripper::set(std::string_view name, int value)
{
  const auto member = request(name);
  if (member == nullptr || value < 0 || value > 255) {
    return false;
  }
  requests_.*member = value;
  return true;
}

std::optional<int> RobotiqGripper::get(std::string_view name) const
{
  if (name == "POS") {
    return static_cast<int>(std::lround(position_));
  }
  if (name == "PRE") {
    return echo_;
  }
  if (name == "STA") {
    return static_cast<int>(status_);
  }
  if (name == "OBJ") {
    return static_cast<int>(contact_);
  }
  if (name == "FLT") {
    return fault();
  }
  const auto member = request(name);
  return member == nullptr ? std::optional<int>() : requests_.*member;
}

void RobotiqGripper::set_active()
{
  requests_.activate = 1;
  status_ = Status::active;
}

void RobotiqGripper::set_object(double width, double stiffness)
{
  object_width_ = width;
  object_stiffness_ = stiffness;
}

double RobotiqGripper::width() const
{
  return stroke * (1.0 - position_ / closed_position);
}

double RobotiqGripper::speed() const
{
  return scale(requests_.speed, min_speed, max_speed);
}

int RobotiqGripper::fault() const
{
  if (fault_ != 0) {
    return fault_;
  }
  if (requests_.activate != 0 && requests_.release != 0) {
    return released_ ? release_completed_fault : release_in_progress_fault;
  }
  if (requests_.go_to == 0 || status_ == Status::active) {
    return 0;
  }
  return requests_.activate != 0 ? action_delayed_fault : activation_required_fault;
}

void RobotiqGripper::reset()
{
  status_ = Status::reset;
  contact_ = Contact::none;
  closed_once_ = false;
  released_ = false;
  if (fault_ >= first_major_fault) {
    fault_ = 0;
  }
}

void RobotiqGripper::step(double duration, bool powered)
{
  powered_ = powered;
  if (!powered) {
    requests_ = {};
    fault_ = 0;
  }
  echo_ = requests_.position;
  if (requests_.activate != 0 && (fault_ == action_delayed_fault || fault_ == activation_required_fault)) {
    fault_ = 0;
  }
  if (requests_.activate == 0) {
    reset();
  } else if (fault_ == 0 && requests_.release != 0) {
    release(duration);
  } else if (fault_ == 0 && status_ != Status::active) {
    activate(duration);
  } else if (fault_ == 0 && requests_.go_to != 0) {
    move(requests_.position, speed(), duration);
  }
}

/// The activation closes and opens the fingers completely.
void RobotiqGripper::activate(double duration)
{
  status_ = Status::activating;
  move(closed_once_ ? 0.0 : closed_position, max_speed, duration);
  if (contact_ == Contact::none) {
    return;
  }
  if (!closed_once_) {
    closed_once_ = true;
  } else {
    status_ = Status::active;
  }
}

void RobotiqGripper::release(double duration)
{
  status_ = Status::reset;
  move(requests_.release_closes != 0 ? closed_position : 0.0, release_speed, duration);
  released_ = contact_ != Contact::none;
}

/// Where an object stops the fingers; beyond their range without an object.
double RobotiqGripper::holding_position(int force) const
{
  const double compression = 1000.0 * scale(force, min_force, max_force) / object_stiffness_;  // mm
  const double width = object_width_ - compression;
  return width > 0.0 ? closed_position * (1.0 - width / stroke) : std::numeric_limits<double>::infinity();
}

void RobotiqGripper::move(double requested, double speed, double duration)
{
  const double target = std::min<double>(requested, closed_position);
  const double per_millimeter = closed_position / stroke;
  const double step = stuck_ ? 0.0 : speed * per_millimeter * duration;
  double next = position_ + std::clamp(target - position_, -step, step);
  const bool blocked =
      target > position_ && next > holding_position(requests_.force) && position_ <= holding_position(255);
  if (blocked) {
    next = std::max(position_, holding_position(requests_.force));
  }
  position_ = next;
  if (position_ == target) {
    contact_ = Contact::at_position;
  } else if (blocked || stuck_) {
    contact_ = target > position_ ? Contact::closing : Contact::opening;
  } else {
    contact_ = Contact::none;
  }
}

}  // namespace ur_simulator
