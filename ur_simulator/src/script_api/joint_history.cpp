#include "script_api/robot_library.hpp"

namespace ur_simulator {

void JointHistory::record(const Vector6 & position)
{
  positions_[count_++ % capacity] = position;
}

std::optional<Vector6> JointHistory::back(std::size_t steps) const
{
  if (steps >= count_ || steps >= capacity) {
    return std::nullopt;
  }
  return positions_[(count_ - 1 - steps) % capacity];
}

}  // namespace ur_simulator
