#pragma once

#include <rmw/types.h>

#include "rcl_cxx/qos.hpp"

namespace rcl_cxx::detail {
rmw_qos_profile_t to_rmw(const QoS & qos);
}
