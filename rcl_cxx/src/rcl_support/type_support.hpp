#pragma once

#include <rosidl_runtime_c/action_type_support_struct.h>
#include <rosidl_runtime_c/message_type_support_struct.h>
#include <rosidl_runtime_c/service_type_support_struct.h>

namespace rcl_cxx::detail {
/// Returns the type support of the middleware if this is rmw_fastrtps_cpp, otherwise the argument, from which
/// the middleware selects its own. If rmw_fastrtps_cpp selects it, it also loads the introspection type
/// support, and keeps a description of each type in memory for type propagation: 9 MB with 130 actions
/// (docs/discovery.md).
const rosidl_message_type_support_t * middleware_type_support(const rosidl_message_type_support_t * type);
const rosidl_service_type_support_t * middleware_type_support(const rosidl_service_type_support_t * type);
/// The result must not be destroyed before the server.
rosidl_action_type_support_t middleware_type_support(const rosidl_action_type_support_t & type);

/// Resets the error state that rmw_fastrtps_cpp leaves when it finds no introspection type support, although
/// the function that creates the publisher, subscription, service or action server succeeds.
void reset_type_support_error();

}  // namespace rcl_cxx::detail
