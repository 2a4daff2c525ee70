#include "ur_ros_rtde/outputs.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = RtdeSubscription::Clock;

/// Without a package, the connection counts as lost (RtdeSubscription::silence_limit()).
constexpr std::chrono::milliseconds min_silence_limit{500};
/// How soon the thread notices that it is to end.
constexpr std::chrono::milliseconds interval{50};

RtdeSubscription open(const Robot & robot, const std::vector<std::string> & names, double frequency)
{
  if (Status known = check_rtde_outputs(names); !known) {
    throw RobotError(known.error());
  }
  auto subscription = RtdeSubscription::open(robot.address(), names, frequency);
  if (!subscription) {
    throw RobotError(subscription.error());
  }
  return std::move(*subscription);
}

Error silence(Clock::duration limit)
{
  return {ErrorCode::link_lost,
          fmt::format("no package with the outputs for {} ms",
                      std::chrono::duration_cast<std::chrono::milliseconds>(limit).count())};
}

}  // namespace

Outputs::Outputs(const Robot & robot, const std::vector<std::string> & names, double frequency)
    : subscription_(open(robot, names, frequency)), incoming_(subscription_.width())
{
  const auto limit = subscription_.silence_limit(min_silence_limit);
  const auto got = subscription_.next(incoming_, Clock::now() + limit);
  if (!got || !*got) {
    throw RobotError(got ? silence(limit) : got.error());
  }
  values_ = incoming_;
  thread_ = std::jthread([this](const std::stop_token & stop) { receive(stop); });
}

void Outputs::receive(const std::stop_token & stop)
{
  const auto limit = subscription_.silence_limit(min_silence_limit);
  for (auto last = Clock::now(); !stop.stop_requested();) {
    const auto got = subscription_.next(incoming_, Clock::now() + interval);
    const std::lock_guard lock(mutex_);
    if (got && *got) {
      last = Clock::now();
      values_.swap(incoming_);
    } else if (!got || Clock::now() - last > limit) {
      lost_ = got ? silence(limit) : got.error();
      return;
    }
  }
}

Outputs::Place Outputs::find(std::string_view name) const
{
  std::size_t first = 0;
  for (const auto & field : subscription_.fields()) {
    if (field.name == name) {
      return {first, field.size};
    }
    first += field.size;
  }
  throw RobotError({ErrorCode::invalid_goal, fmt::format("the output {} was not asked for", name)});
}

std::vector<double> Outputs::newest() const
{
  const std::lock_guard lock(mutex_);
  if (lost_) {
    throw RobotError(*lost_);
  }
  return values_;
}

std::vector<double> Outputs::vector(std::string_view name) const
{
  const auto [first, count] = find(name);
  const std::vector<double> values = newest();
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

std::vector<double> Outputs::read(const std::vector<std::string_view> & names) const
{
  const std::vector<double> values = newest();
  std::vector<double> result;
  for (const std::string_view name : names) {
    const auto [first, count] = find(name);
    if (count != 1) {
      throw RobotError(
          {ErrorCode::invalid_goal, fmt::format("the output {} has {} values: use vector()", name, count)});
    }
    result.push_back(values[first]);
  }
  return result;
}

}  // namespace ur_ros_rtde
