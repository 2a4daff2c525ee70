#pragma once

#include <functional>
#include <memory>
#include <rosidl_typesupport_cpp/service_type_support.hpp>
#include <string>
#include <utility>

#include "rcl_cxx/callback_group.hpp"
#include "rcl_cxx/qos.hpp"

namespace rcl_cxx {
namespace detail {
class NodeImpl;
class ServiceImpl;

struct ErasedService {
  const rosidl_service_type_support_t * type_support;
  std::shared_ptr<void> (*make_request)();
  std::shared_ptr<void> (*make_response)();
  std::function<void(const void * request, void * response)> callback;
};
}  // namespace detail

/// A service without its type.
class ServiceBase {
 public:
  ServiceBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedService erased, const std::string & name,
              const QoS & qos, CallbackGroup::SharedPtr group);
  /// Waits for a running callback (see SubscriptionBase).
  virtual ~ServiceBase();
  ServiceBase(const ServiceBase &) = delete;
  ServiceBase & operator=(const ServiceBase &) = delete;

  const std::string & get_service_name() const noexcept;

 private:
  std::shared_ptr<detail::ServiceImpl> impl_;
};

/// Created by Node::create_service. The callback fills the response, in the thread of its group. If it
/// throws, the exception is logged and the response is sent as far as it has been filled.
template <typename S>
class Service : public ServiceBase {
 public:
  using SharedPtr = std::shared_ptr<Service<S>>;
  using Request = typename S::Request;
  using Response = typename S::Response;

  template <typename F>
  Service(std::shared_ptr<detail::NodeImpl> node, F && callback, const std::string & name, const QoS & qos,
          CallbackGroup::SharedPtr group = {})
      : ServiceBase(std::move(node),
                    {rosidl_typesupport_cpp::get_service_type_support_handle<S>(),
                     []() -> std::shared_ptr<void> { return std::make_shared<Request>(); },
                     []() -> std::shared_ptr<void> { return std::make_shared<Response>(); },
                     [f = std::forward<F>(callback)](const void * request, void * response) mutable {
                       f(*static_cast<const Request *>(request), *static_cast<Response *>(response));
                     }},
                    name, qos, std::move(group))
  {
  }
};

}  // namespace rcl_cxx
