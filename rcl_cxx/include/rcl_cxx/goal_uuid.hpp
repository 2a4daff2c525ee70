#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <string>

namespace rcl_cxx {
/// The UUID of an action goal.
struct GoalUUID {
  std::array<std::uint8_t, 16> bytes{};

  /// A random (version 4) one.
  static GoalUUID random();

  bool is_zero() const noexcept { return *this == GoalUUID{}; }
  /// "3f0c…-…", 36 characters.
  std::string to_string() const;
  /// The first 8 characters: enough for a log line.
  std::string short_string() const;

  auto operator<=>(const GoalUUID &) const = default;
};

/// Numbers are those of action_msgs/msg/GoalStatus.
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

template <>
struct std::hash<rcl_cxx::GoalUUID> {
  std::size_t operator()(const rcl_cxx::GoalUUID & id) const noexcept;
};
