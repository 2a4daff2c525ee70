#include <algorithm>

#include "script_api/robot_library.hpp"

namespace ur_simulator {

void JointHistory::record(const Vector6 & position)
{
  positions_[count_++ % capacity] = position;
}

std::optional<Vector6> JointHistory::back(std::size_t steps) const
{
  if (count_ == 0 || steps >= capacity) {
    return std::nullopt;
  }
  // Just switched on, it has stood where the first record says.
  return positions_[(count_ - 1 - std::min(steps, count_ - 1)) % capacity];
}

}  // namespace ur_simulator
