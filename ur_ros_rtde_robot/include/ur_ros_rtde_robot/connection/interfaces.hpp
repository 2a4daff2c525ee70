#pragma once

// ur_rtde's interfaces, complete: what calls a function through Robot::control() and its like includes this.
#include <ur_rtde/dashboard_client.h>
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_io_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

#include "ur_ros_rtde_robot/robot.hpp"
