#include "rcl_support/type_support.hpp"

#include <rcl/error_handling.h>
#include <rmw/rmw.h>

#include <string_view>

namespace rcl_cxx::detail {
namespace {
/// `find` is rosidl's function for messages or for services.
template <typename TypeSupport>
const TypeSupport * find_type_support(const TypeSupport * type,
                                      const TypeSupport * (*find)(const TypeSupport *, const char *))
{
  if (type == nullptr || std::string_view(rmw_get_implementation_identifier()) != "rmw_fastrtps_cpp") {
    return type;
  }
  const TypeSupport * const found = find(type, "rosidl_typesupport_fastrtps_cpp");
  if (found == nullptr) {
    rcl_reset_error();  // the middleware will report that there is none
    return type;
  }
  return found;
}
}  // namespace

const rosidl_message_type_support_t * middleware_type_support(const rosidl_message_type_support_t * type)
{
  return find_type_support(type, &get_message_typesupport_handle);
}

const rosidl_service_type_support_t * middleware_type_support(const rosidl_service_type_support_t * type)
{
  return find_type_support(type, &get_service_typesupport_handle);
}

rosidl_action_type_support_t middleware_type_support(const rosidl_action_type_support_t & type)
{
  rosidl_action_type_support_t result = type;
  result.goal_service_type_support = middleware_type_support(type.goal_service_type_support);
  result.result_service_type_support = middleware_type_support(type.result_service_type_support);
  result.cancel_service_type_support = middleware_type_support(type.cancel_service_type_support);
  result.feedback_message_type_support = middleware_type_support(type.feedback_message_type_support);
  result.status_message_type_support = middleware_type_support(type.status_message_type_support);
  return result;
}

void reset_type_support_error()
{
  rcl_reset_error();
}

}  // namespace rcl_cxx::detail
