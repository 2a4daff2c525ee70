#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/types.hpp"

namespace ur_simulator {

/// Joint positions of the last cycles, for get_actual_joint_positions_history(). The controller calls
/// record() once per cycle.
class JointHistory {
 public:
  static constexpr std::size_t capacity = 1024;

  void record(const Vector6 & position);
  /// The position `steps` cycles ago (0: the last recorded); nothing if it is no longer stored.
  std::optional<Vector6> position(std::size_t steps) const;

 private:
  std::array<Vector6, capacity> positions_{};
  std::size_t count_ = 0;
};

}  // namespace ur_simulator
