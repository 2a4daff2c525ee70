#include "script_api/joint_history.hpp"

#include <algorithm>

namespace ur_simulator {

void JointHistory::record(const Vector6 & position)
{
  positions_[count_++ % capacity] = position;
}

std::optional<Vector6> JointHistory::position(std::size_t steps) const
{
  if (count_ == 0 || steps >= capacity) {
    return std::nullopt;
  }
  // Before the first record the arm stood at the first recorded position.
  return positions_[(count_ - 1 - std::min(steps, count_ - 1)) % capacity];
}

}  // namespace ur_simulator
