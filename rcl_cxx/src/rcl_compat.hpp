#pragma once

/// Everything in which the versions of rcl differ (Humble 5.3, Jazzy 9.2, Kilted 10.1, Rolling). The only
/// place that looks at a version.

#include <rcl/graph.h>
#include <rcl/logging_rosout.h>
#include <rcl/node.h>
#include <rcl/timer.h>
#include <rcl_action/rcl_action.h>

#if __has_include(<rcl/version.h>)
#include <rcl/version.h>
#else
#define RCL_VERSION_MAJOR 5  // Humble's and older have no such header
#endif

#if __has_include(<rmw/events_statuses/incompatible_qos.h>)
#include <rmw/events_statuses/incompatible_qos.h>
#else
#include <rmw/incompatible_qos_events_statuses.h>  // Humble
#endif

#if RCL_VERSION_MAJOR >= 6
#define RCL_CXX_HAS_TYPE_DESCRIPTION_SERVICE 1
#include <type_description_interfaces/srv/get_type_description.h>
#else
#define RCL_CXX_HAS_TYPE_DESCRIPTION_SERVICE 0
#endif

namespace rcl_cxx::detail::compat {
/// A timer that does not run yet.
inline rcl_ret_t timer_init_canceled(rcl_timer_t * timer, rcl_clock_t * clock, rcl_context_t * context,
                                     std::int64_t period_ns)
{
#if RCL_VERSION_MAJOR >= 9
  return rcl_timer_init2(timer, clock, context, period_ns, nullptr, rcl_get_default_allocator(), false);
#else
  const rcl_ret_t code =
      rcl_timer_init(timer, clock, context, period_ns, nullptr, rcl_get_default_allocator());
  return code == RCL_RET_OK ? rcl_timer_cancel(timer) : code;
#endif
}

/// From Kilted on the server's timer of expiry comes from outside, before it made its own from `clock`.
inline rcl_ret_t action_server_init(rcl_action_server_t * server, rcl_node_t * node,
                                    const rcl_timer_t * expire_timer, rcl_clock_t * clock,
                                    const rosidl_action_type_support_t * type_support, const char * name,
                                    const rcl_action_server_options_t * options)
{
#if RCL_VERSION_MAJOR >= 10
  static_cast<void>(clock);
  return rcl_action_server_init2(server, node, expire_timer, type_support, name, options);
#else
  static_cast<void>(expire_timer);
  return rcl_action_server_init(server, node, clock, type_support, name, options);
#endif
}

/// Clients cannot be counted before Jazzy: 1, because one may be there.
inline rcl_ret_t count_clients(const rcl_node_t * node, const char * service, std::size_t * count)
{
#if RCL_VERSION_MAJOR >= 9
  return rcl_count_clients(node, service, count);
#else
  *count = 1;
  return rcl_node_is_valid(node) && service != nullptr ? RCL_RET_OK : RCL_RET_NODE_INVALID;
#endif
}

/// The node's publisher on /rosout. rcl itself makes it up to Iron, the client libraries do from Jazzy on.
inline rcl_ret_t rosout_start(rcl_node_t * node)
{
#if RCL_VERSION_MAJOR >= 9
  return rcl_logging_rosout_init_publisher_for_node(node);
#else
  return rcl_node_is_valid(node) ? RCL_RET_OK : RCL_RET_NODE_INVALID;
#endif
}

/// Where rcl itself made it, rcl finds later that there is nothing left to end.
inline rcl_ret_t rosout_stop(rcl_node_t * node)
{
  return rcl_logging_rosout_fini_publisher_for_node(node);
}

/// Lets messages of logger "<logger>.<child>" appear in the /rosout of `logger`'s node. Since Jazzy.
inline bool rosout_add_child(const char * logger, const char * child)
{
#if RCL_VERSION_MAJOR >= 6
  return rcl_logging_rosout_add_sublogger(logger, child) == RCL_RET_OK;
#else
  return logger == nullptr && child == nullptr;
#endif
}

inline rcl_ret_t rosout_remove_child(const char * logger, const char * child)
{
#if RCL_VERSION_MAJOR >= 6
  return rcl_logging_rosout_remove_sublogger(logger, child);
#else
  return logger != nullptr && child != nullptr ? RCL_RET_OK : RCL_RET_ERROR;
#endif
}

}  // namespace rcl_cxx::detail::compat
