#pragma once

// Complete types of ur_rtde's interfaces. Include this to call functions through Robot::control() etc.
#include <ur_rtde/dashboard_client.h>
#include <ur_rtde/rtde_control_interface.h>
#include <ur_rtde/rtde_io_interface.h>
#include <ur_rtde/rtde_receive_interface.h>

// Another installation of ur_rtde must not replace the patched library of the package ur_rtde_vendor.
#ifndef UR_RTDE_VENDOR_HEADERS
#error "These are not the ur_rtde headers of ur_rtde_vendor. Remove find_package(ur_rtde) from this project."
#endif
