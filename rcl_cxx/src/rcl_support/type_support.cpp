#include "rcl_support/type_support.hpp"

#include <rcl/error_handling.h>
#include <rmw/rmw.h>

#include <map>
#include <mutex>
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
  if (compat::requires_introspection ||
      std::string_view(rmw_get_implementation_identifier()) != "rmw_fastrtps_cpp") {
    return type;
  }
  const T * const found = find(type, "rosidl_typesupport_fastrtps_cpp");
  if (found == nullptr) {
    rcl_reset_error();  // the middleware will report that there is none
    return type;
  }
  return found;
}
/// Thread-safe. A library that was loaded at the place of another one may have its type there.
template <typename T>
const T * make_copy(const T * generated)
{
  static std::mutex mutex;
  static std::map<const T *, T> & copies =
      *new std::map<const T *, T>();  // not destroyed before participants
  T copy = *find_type_support(generated);
  compat::remove_type_description(copy);
  const std::lock_guard lock(mutex);
  const auto [known, is_new] = copies.try_emplace(generated, copy);
  if (!is_new && known->second.data != copy.data) {
    known->second = copy;
  }
  return &known->second;
}
}  // namespace

template <typename T>
TypeSupport<T>::TypeSupport(const T * generated)
    : copy_(generated == nullptr ? nullptr : make_copy(generated))
{
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
