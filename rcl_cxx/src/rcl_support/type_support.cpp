#include "rcl_support/type_support.hpp"

#include <rcl/error_handling.h>
#include <rmw/rmw.h>

#include <string_view>

#include "rcl_support/rcl_compat.hpp"

namespace rcl_cxx::detail {
namespace {
const rosidl_message_type_support_t * find(const rosidl_message_type_support_t * type,
                                           const char * identifier)
{
  return get_message_typesupport_handle(type, identifier);
}

const rosidl_service_type_support_t * find(const rosidl_service_type_support_t * type,
                                           const char * identifier)
{
  return get_service_typesupport_handle(type, identifier);
}

template <typename T>
const T * find_type_support(const T * type)
{
  if (std::string_view(rmw_get_implementation_identifier()) != "rmw_fastrtps_cpp") {
    return type;
  }
  const T * const found = find(type, "rosidl_typesupport_fastrtps_cpp");
  if (found == nullptr) {
    rcl_reset_error();  // the middleware will report that there is none
    return type;
  }
  return found;
}
}  // namespace

template <typename T>
TypeSupport<T>::TypeSupport(const T * generated)
{
  if (generated != nullptr) {
    copy_ = *find_type_support(generated);
    compat::remove_type_description(*copy_);
  }
}

template class TypeSupport<rosidl_message_type_support_t>;
template class TypeSupport<rosidl_service_type_support_t>;

ActionTypeSupport::ActionTypeSupport(const rosidl_action_type_support_t & generated)
    : goal_(generated.goal_service_type_support),
      result_(generated.result_service_type_support),
      cancel_(generated.cancel_service_type_support),
      feedback_(generated.feedback_message_type_support),
      status_(generated.status_message_type_support),
      copy_(generated)
{
  copy_.goal_service_type_support = goal_.get();
  copy_.result_service_type_support = result_.get();
  copy_.cancel_service_type_support = cancel_.get();
  copy_.feedback_message_type_support = feedback_.get();
  copy_.status_message_type_support = status_.get();
  compat::remove_type_description(copy_);
}

void reset_type_support_error()
{
  rcl_reset_error();
}

}  // namespace rcl_cxx::detail
