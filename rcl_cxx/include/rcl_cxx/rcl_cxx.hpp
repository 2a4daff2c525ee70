#pragma once

/// All of rcl_cxx, a small C++20 client library on rcl and rcl_action.

#include "rcl_cxx/action_server.hpp"
#include "rcl_cxx/context.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/executor.hpp"
#include "rcl_cxx/goal_uuid.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_cxx/node.hpp"
#include "rcl_cxx/parameter.hpp"
#include "rcl_cxx/parameter_value.hpp"
#include "rcl_cxx/publisher.hpp"
#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/server_goal_handle.hpp"
#include "rcl_cxx/service.hpp"
#include "rcl_cxx/subscription.hpp"
#include "rcl_cxx/timer.hpp"
