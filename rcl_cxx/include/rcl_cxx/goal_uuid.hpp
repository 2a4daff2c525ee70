#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>

namespace rcl_cxx {
/// The id of an action goal.
struct GoalUUID {
  std::array<std::uint8_t, 16> bytes{};

  /// A random (version 4) UUID.
  static GoalUUID random();

  /// "3f0c…-…", 36 characters.
  std::string to_string() const;
  /// The first 8 characters, for log messages.
  std::string short_string() const;

  auto operator<=>(const GoalUUID &) const = default;
};

/// The values match action_msgs/msg/GoalStatus.
enum class GoalStatus : std::int8_t {
  unknown = 0,
  accepted = 1,
  executing = 2,
  canceling = 3,
  succeeded = 4,
  canceled = 5,
  aborted = 6
};

const char * to_string(GoalStatus status) noexcept;

constexpr bool is_terminal(GoalStatus status) noexcept
{
  return status == GoalStatus::succeeded || status == GoalStatus::canceled || status == GoalStatus::aborted;
}

}  // namespace rcl_cxx
