#pragma once

#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde::kinematics {

/// Joint positions in rad, far from singularities.
inline Joints home()
{
  Joints q;
  q << 0.0, -1.57, 1.57, -1.57, -1.57, 0.0;
  return q;
}

}  // namespace ur_ros_rtde::kinematics
