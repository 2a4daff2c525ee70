#pragma once

/// The differences between versions of rcl (Humble 5.3, Jazzy 9.2, Kilted 10.1, Rolling).

#include <rcl/event.h>
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

namespace rcl_cxx::detail::compat {
/// Up to Jazzy, rmw_fastrtps_cpp rejects a type of which it does not find the introspection type support.
inline constexpr bool requires_introspection = RCL_VERSION_MAJOR < 10;
/// The same middlewares send the text before a null character, instead of rejecting the message.
inline constexpr bool truncates_at_null_character = RCL_VERSION_MAJOR < 10;

/// Initializes a canceled timer.
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

/// Since Kilted, the caller provides the expire timer. Before, the server made its own from `clock`.
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

/// Humble does not report a new subscription to a publisher.
inline constexpr bool reports_subscriptions = RCL_VERSION_MAJOR >= 6;
/// The event that a subscription to the topic of `publisher` has appeared or gone.
inline rcl_ret_t matched_event_init(rcl_event_t * event, const rcl_publisher_t * publisher)
{
#if RCL_VERSION_MAJOR >= 6
  return rcl_publisher_event_init(event, publisher, RCL_PUBLISHER_MATCHED);
#else
  return rcl_publisher_is_valid(publisher) && event != nullptr ? RCL_RET_UNSUPPORTED
                                                               : RCL_RET_INVALID_ARGUMENT;
#endif
}

/// Clients cannot be counted before Jazzy. 1, because there may be a client.
inline rcl_ret_t count_clients(const rcl_node_t * node, const char * service, std::size_t * count)
{
#if RCL_VERSION_MAJOR >= 9
  return rcl_count_clients(node, service, count);
#else
  *count = 1;
  return rcl_node_is_valid(node) && service != nullptr ? RCL_RET_OK : RCL_RET_NODE_INVALID;
#endif
}

/// The node's publisher on /rosout. rcl creates it up to Iron, the client library since Jazzy.
inline rcl_ret_t rosout_start(rcl_node_t * node)
{
#if RCL_VERSION_MAJOR >= 9
  return rcl_logging_rosout_init_publisher_for_node(node);
#else
  return rcl_node_is_valid(node) ? RCL_RET_OK : RCL_RET_NODE_INVALID;
#endif
}

/// Before Jazzy, rcl finds later that the publisher is gone.
inline rcl_ret_t rosout_stop(rcl_node_t * node)
{
  return rcl_logging_rosout_fini_publisher_for_node(node);
}

/// Replaces the description of a type, of a message, a service or an action, by an empty one. Before Iron,
/// there are no descriptions.
template <typename TypeSupport>
void remove_type_description([[maybe_unused]] TypeSupport & type)
{
#if RCL_VERSION_MAJOR >= 6
  using Description = rosidl_runtime_c__type_description__TypeDescription;
  using Sources = rosidl_runtime_c__type_description__TypeSource__Sequence;
  type.get_type_description_func = [](const TypeSupport *) -> const Description * {
    static char no_name[] = "";
    static const Description empty{
        .type_description = {.type_name = {.data = no_name, .size = 0, .capacity = 1}, .fields = {}},
        .referenced_type_descriptions = {}};
    return &empty;
  };
  type.get_type_description_sources_func = [](const TypeSupport *) -> const Sources * {
    static const Sources empty{};
    return &empty;
  };
#endif
}

}  // namespace rcl_cxx::detail::compat
