#pragma once

#include <rosidl_runtime_c/action_type_support_struct.h>
#include <rosidl_runtime_c/message_type_support_struct.h>
#include <rosidl_runtime_c/service_type_support_struct.h>

namespace rcl_cxx::detail {
/// The type support that rcl receives, a copy of the generated one with two differences. With
/// rmw_fastrtps_cpp since Kilted it is that of the middleware: if rmw_fastrtps_cpp selects it, it also loads
/// the introspection type support, and keeps a description of each type in memory for type propagation. And
/// rcl finds no description of the type, of which it would keep a copy for the service
/// ~/get_type_description, which this library does not provide. With 130 actions, this saves 9 MB and 7 MB
/// (docs/internals/discovery.md).
///
/// The copy is kept until the process ends, like the generated one: a participant of Fast DDS refers to the
/// type support of a type that was registered once, even when the entity is gone and another one is created.
/// `T` is a type support of messages or of services.
template <typename T>
class TypeSupport {
 public:
  /// nullptr is passed on to rcl, which reports it.
  explicit TypeSupport(const T * generated);

  const T * get() const noexcept { return copy_; }

 private:
  const T * copy_;
};

using MessageTypeSupport = TypeSupport<rosidl_message_type_support_t>;
using ServiceTypeSupport = TypeSupport<rosidl_service_type_support_t>;

/// The same for actions.
class ActionTypeSupport {
 public:
  explicit ActionTypeSupport(const rosidl_action_type_support_t & generated);
  ActionTypeSupport(const ActionTypeSupport &) = delete;
  ActionTypeSupport & operator=(const ActionTypeSupport &) = delete;

  const rosidl_action_type_support_t * get() const noexcept { return &copy_; }

 private:
  const ServiceTypeSupport goal_;
  const ServiceTypeSupport result_;
  const ServiceTypeSupport cancel_;
  const MessageTypeSupport feedback_;
  const MessageTypeSupport status_;
  rosidl_action_type_support_t copy_;
};

/// Resets the error state that rmw_fastrtps_cpp leaves when it finds no introspection type support, although
/// the function that creates the publisher, subscription, service or action server succeeds.
void reset_type_support_error();

}  // namespace rcl_cxx::detail
